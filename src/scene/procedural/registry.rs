//! The scenes by name.

use super::{
    chessboard, gazebo, glass_leaved_tree, highchair, house_of_cards, kitchen, large, spd, stack,
    three_spheres,
};
use crate::error::{Error, Result};
use crate::scene::Scene;

/// A scene that is made and not read.
#[derive(Debug, Clone, Copy)]
pub struct Builtin {
    /// What it is asked for by.
    pub name: &'static str,
    /// What it shows, in a line.
    pub summary: &'static str,
    /// How large it can be made, if that can be chosen.
    pub size_factor: Option<SizeFactor>,
    make: Make,
}

/// How large a scene can be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SizeFactor {
    /// The smallest that leaves nothing out.
    pub smallest: u32,
    /// The size of the published statistics.
    pub standard: u32,
    /// The largest whose primitives are within what a scene may hold.
    pub largest: u32,
}

#[derive(Debug, Clone, Copy)]
enum Make {
    /// There is one size.
    Fixed(fn() -> Result<Scene>),
    /// By size factor.
    Sized(fn(u32) -> Result<Scene>),
}

/// All of them: the environments of the paper in its order, the databases in theirs, the scenes of the t-buffer
/// paper, and large ones.
pub const BUILTIN: &[Builtin] = &[
    fixed("chessboard", "a game of chess after four moves (figure 5)", chessboard::build),
    fixed("house-of-cards", "forty cards on a polished table (figure 6)", house_of_cards::build),
    fixed("highchair", "a child's chair of turned wood (figure 7)", highchair::build),
    fixed("gazebo", "an octagonal gazebo by candles and moonlight (figure 8)", gazebo::build),
    fixed(
        "glass-leaved-tree",
        "a tree with spheres of glass for leaves (figure 9)",
        glass_leaved_tree::build,
    ),
    fixed("counter-top", "glass, fruit and pots on a polished counter (figure 10)", kitchen::counter_top),
    fixed("kitchen", "the same from further away (figure 11)", kitchen::kitchen),
    sized("balls", "a fractal of mirroring spheres", [1, 4, 6], spd::balls),
    sized("gears", "a block of gears, some of glass", [1, 4, 48], spd::gears),
    sized("mount", "a fractal mountain and four spheres of glass", [1, 6, 12], spd::mount),
    sized("rings", "a pyramid of linked rings", [1, 7, 80], spd::rings),
    sized("teapot", "Newell's teapot on a chequered ground", [2, 12, 1000], spd::teapot),
    sized("tetra", "Sierpinski's tetrahedron", [1, 6, 11], spd::tetra),
    sized("tree", "a tree of cones and spheres under seven lights", [1, 11, 18], spd::tree),
    fixed(
        "three-spheres",
        "three stacked spheres on an infinite ground (2004, figure 9)",
        three_spheres::build,
    ),
    sized(
        "stacked-spheres",
        "spheres that fill the view (2004, figure 12)",
        [1, 50, 100_000],
        stack::spheres,
    ),
    sized(
        "stacked-triangles",
        "triangles that fill the view (2004, figure 12)",
        [1, 50, 100_000],
        stack::triangles,
    ),
    sized("sphereflake", "a fractal of balls, each a closed mesh", [1, 4, 5], large::sphereflake),
    sized("terrain", "mountains under a low light", [22, 700, 2200], large::terrain),
    sized("hair-ball", "strands of thin triangles around a ball", [1, 1040, 10_000], large::hair_ball),
    sized("city", "towers with deep windows in narrow streets", [1, 16, 50], large::city),
    sized("forest", "trees with every leaf and every needle", [1, 20, 28], large::forest),
];

const fn fixed(name: &'static str, summary: &'static str, make: fn() -> Result<Scene>) -> Builtin {
    Builtin { name, summary, size_factor: None, make: Make::Fixed(make) }
}

const fn sized(
    name: &'static str,
    summary: &'static str,
    [smallest, standard, largest]: [u32; 3],
    make: fn(u32) -> Result<Scene>,
) -> Builtin {
    Builtin {
        name,
        summary,
        size_factor: Some(SizeFactor { smallest, standard, largest }),
        make: Make::Sized(make),
    }
}

/// The name that stands for all of [`hard_cases`](crate::hard_cases), which are no scene.
pub const HARD_CASES: &str = "hard-cases";

/// The scene of this name.
///
/// # Errors
/// [`Error::Usage`] if there is none; the line lists those that there are.
pub fn find(name: &str) -> Result<&'static Builtin> {
    if name == HARD_CASES {
        let why = "it is many small scenes, and not one that could be drawn";
        return Err(Error::Usage(format!("builtin:{name} is for `validate` alone: {why}")));
    }
    BUILTIN.iter().find(|scene| scene.name == name).ok_or_else(|| {
        let names: Vec<_> = BUILTIN.iter().map(|scene| scene.name).collect();
        Error::Usage(format!("no built-in scene `{name}`; there are {}", names.join(", ")))
    })
}

impl Builtin {
    /// Makes the scene, of the standard size if none is given.
    ///
    /// # Errors
    /// [`Error::Usage`] for a size factor that the scene does not have, or of which it would be too small or
    /// too large.
    pub fn build(&self, size_factor: Option<u32>) -> Result<Scene> {
        let wrong = |what: String| Err(Error::Usage(format!("builtin:{}: {what}", self.name)));
        match (self.make, self.size_factor, size_factor) {
            (Make::Fixed(_), _, Some(_)) => wrong("the scene has one size; expected no size factor".into()),
            (Make::Fixed(make), _, None) => make(),
            (Make::Sized(make), Some(range), factor) => {
                let factor = factor.unwrap_or(range.standard);
                match (range.smallest..=range.largest).contains(&factor) {
                    true => make(factor),
                    false => wrong(format!(
                        "expected a size factor from {} to {}, found {factor}",
                        range.smallest, range.largest
                    )),
                }
            }
            (Make::Sized(_), None, _) => wrong("the scene has no range of sizes".into()),
        }
    }
}
