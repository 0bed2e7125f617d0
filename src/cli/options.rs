//! Options that commands share, and how their values are written.

use super::view::LookRules;
use crate::error::{Error, Result};
use crate::geometry::LightPosition;
use crate::geometry::batch::InstructionSet;
use crate::memory::{self, MemoryLimit};
use crate::scene::{ImageSize, Scene};
use crate::shading::{Following, Textures, TreeRules, USUAL_DEPTH};
use crate::shadow::shadow_buffer::sphere::Sphere;
use crate::shadow::shadow_buffer::{DepthBias, FilterWidth, Lookup, ShadowBufferSettings};
use crate::shadow::{
    BuildInput, Culling, EmbreeSettings, ObjectCoherence, Resolution, SceneIndex, VolumeThreshold,
};
use crate::slurm;
use crate::visibility::FirstHitMethod;
use clap::Args;
use glam::Vec3;
use std::num::NonZero;
use std::path::PathBuf;

/// What is looked at, and from where.
#[derive(Debug, Args)]
pub struct ViewOptions {
    /// Scene file: .obj, .ply, .gltf, .glb, .nff or .toml; or builtin:NAME, see generate --list
    pub scene: PathBuf,
    /// Image size in pixels [default: the camera's own if the scene says one, else 1280x720]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<ImageSize>,
    /// Rays through the corners of pixels in place of their centres: an image of one more row and column, as
    /// the Standard Procedural Databases are counted
    #[arg(long)]
    pub corner_rays: bool,
    /// Camera by name [default: the scene's first]
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// No floor under a mesh that comes without lights
    #[arg(long)]
    pub no_floor: bool,
    /// Treat warnings about the scene as errors
    #[arg(long)]
    pub strict: bool,
}

/// Lights in place of the scene's.
#[derive(Debug, Clone, Args)]
pub struct LightOptions {
    /// A point light here instead of the scene's lights; may be repeated
    #[arg(long = "light", value_name = "X,Y,Z", value_parser = parse_point, allow_hyphen_values = true)]
    pub lights: Vec<Vec3>,
    /// A fixed ring of N point lights above the scene instead of the scene's lights
    #[arg(long = "lights", value_name = "N", conflicts_with = "lights",
          value_parser = clap::value_parser!(u32).range(1..=64))]
    pub rig: Option<u32>,
}

/// A light to be put somewhere, or one to be chosen by name.
#[derive(Debug, Clone, PartialEq)]
pub enum LightArgument {
    /// Put here.
    Position(Vec3),
    /// Chosen by this name.
    Name(String),
}

impl LightArgument {
    /// Where it is put.
    pub fn position(&self) -> Option<Vec3> {
        match self {
            LightArgument::Position(point) => Some(*point),
            LightArgument::Name(_) => None,
        }
    }

    /// The name it is chosen by.
    pub fn name(&self) -> Option<&str> {
        match self {
            LightArgument::Position(_) => None,
            LightArgument::Name(name) => Some(name),
        }
    }
}

/// Three numbers are a place, anything else is a name.
pub fn parse_light_argument(text: &str) -> std::result::Result<LightArgument, String> {
    Ok(parse_point(text).map_or_else(|_| LightArgument::Name(text.into()), LightArgument::Position))
}

/// How far rays are followed.
#[derive(Debug, Args)]
pub struct TreeOptions {
    /// Most rays one behind the other in mirrors and glass, that from the camera included
    #[arg(
        long,
        value_name = "RAYS",
        default_value_t = USUAL_DEPTH,
        value_parser = clap::value_parser!(u32).range(1..=64)
    )]
    pub depth: u32,
}

/// What is left out of a picture, and who finds what the camera sees: the switches of REALITY (2004 paper,
/// section IV).
#[derive(Debug, Args)]
pub struct Switches {
    /// No shadows: light arrives wherever it is faced. No tester is built or asked
    #[arg(long, conflicts_with = "shadow")]
    no_shadows: bool,
    /// No mirrors and no total reflection: no rays are followed for them
    #[arg(long)]
    no_reflections: bool,
    /// No rays through transparent surfaces; shadows stay as they are
    #[arg(long)]
    no_refractions: bool,
    /// Every surface in the one colour of its material; holes of alpha masks stay
    #[arg(long)]
    no_textures: bool,
    /// Who finds what the camera sees: t-buffer object by object, with the rays that its projection covers;
    /// classical every object for every ray; hierarchy ray by ray through boxes. No picture depends on it
    #[arg(long, value_name = "METHOD", default_value = "t-buffer", value_parser = parse_method)]
    first_hits: FirstHitMethod,
}

impl Switches {
    /// Whether shadows are tested.
    pub fn shadows(&self) -> Shadows {
        if self.no_shadows { Shadows::Off } else { Shadows::On }
    }

    /// Whether textures are looked at.
    pub fn textures(&self) -> Textures {
        if self.no_textures { Textures::Off } else { Textures::On }
    }

    /// How a view is looked at, with so many rays one behind the other.
    pub fn look(&self, depth: u32) -> LookRules {
        let following = |left_out: bool| if left_out { Following::Off } else { Following::On };
        let trees = TreeRules {
            depth,
            reflections: following(self.no_reflections),
            refractions: following(self.no_refractions),
        };
        LookRules { first_hits: self.first_hits, trees }
    }

    /// What changes the picture, in words.
    pub fn left_out(&self) -> Vec<&'static str> {
        let switches = [
            (self.no_shadows, "shadows"),
            (self.no_reflections, "reflections"),
            (self.no_refractions, "refractions"),
            (self.no_textures, "textures"),
        ];
        switches.into_iter().filter(|(left_out, _)| *left_out).map(|(_, what)| what).collect()
    }
}

/// Whether shadows are tested.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shadows {
    /// By a tester.
    On,
    /// By none.
    Off,
}

fn parse_method(text: &str) -> std::result::Result<FirstHitMethod, String> {
    FirstHitMethod::ALL.into_iter().find(|method| method.name() == text).ok_or_else(|| {
        let names = FirstHitMethod::ALL.map(FirstHitMethod::name);
        format!("expected {}", names.join(", "))
    })
}

#[derive(Debug, Args)]
pub struct RunOptions {
    /// Instructions that native testers run on: portable, avx2 or avx512 [default: the widest that this machine has]. No
    /// answer depends on it
    #[arg(long, value_name = "SET", value_parser = parse_instruction_set)]
    pub isa: Option<InstructionSet>,
    /// Cells along an edge of the light buffer's cube: 1 to 4096, or auto
    #[arg(long, value_name = "R", default_value = "auto", value_parser = parse_resolution)]
    pub resolution: Resolution,
    /// Whether the light buffer leaves out polygons that face away from the light, as the 1986 paper does:
    /// off, or solids for the far sides of closed solids that the light is outside of. Those are recognised,
    /// never declared: every edge belongs to two triangles that run through it in opposite directions, and
    /// no triangles cross. No answer depends on it
    #[arg(long, value_name = "WHAT", default_value = "off", value_parser = parse_culling)]
    pub cull: Culling,
    /// Put the polygons of one object in a cell of the light buffer behind a bounding volume if they are more
    /// than this; the 1986 paper says 6. No answer depends on it [default: never]
    #[arg(long, value_name = "N")]
    pub volume_threshold: Option<u32>,
    /// Let the light buffer try the triangle that occluded the last point first. No answer depends on it
    #[arg(long)]
    pub object_coherence: bool,
    /// Share of a segment that Embree leaves out at both ends, in [0, 0.5)
    #[arg(long, value_name = "E", default_value_t = 1e-4, value_parser = parse_epsilon)]
    pub embree_epsilon: f32,
    /// Cells of the shadow-buffer from pole to pole and around it, 1 to 65536 each. Decides its answers
    #[arg(long, value_name = "ROWSxCOLUMNS", default_value = "400x800", value_parser = parse_cells)]
    pub shadow_buffer_size: [u32; 2],
    /// When the shadow-buffer calls a point lit: identity, if the cell of its direction holds its own object, as
    /// published; or depth, unless what the cell holds is nearer by more than the bias
    #[arg(long, value_name = "WHAT", default_value = "identity", value_parser = parse_lookup)]
    pub shadow_buffer_lookup: Lookup,
    /// Mean over N x N cells of the shadow-buffer, N odd and at most 63: soft edges in the picture, and dark in
    /// masks where less than half is lit; 1 is off
    #[arg(long, value_name = "N", default_value = "1", value_parser = parse_filter)]
    pub shadow_buffer_filter: FilterWidth,
    /// Share of its distance that something must be nearer than a point to shadow it, in [0, 1), where the
    /// shadow-buffer looks at depths [default: by the width of a cell and of the filter, 0.022 for 400x800]
    #[arg(long, value_name = "E", value_parser = parse_bias)]
    pub shadow_buffer_bias: Option<f32>,
    /// Threads [default: all that the process may use, or SLURM_CPUS_PER_TASK of them]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// The most memory that the run may need beside some 64 MiB, such as 16G; what would need more is refused before
    /// it is asked for [default: what the machine has free, or less if a control group or Slurm allows less]
    #[arg(long, value_name = "BYTES", value_parser = memory::parse)]
    pub memory_limit: Option<MemoryLimit>,
    /// Brighten PNG previews by this many stops
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, allow_hyphen_values = true,
          value_parser = parse_stops)]
    pub exposure: f32,
    /// Print what was built and what every tester did
    #[arg(long)]
    pub stats: bool,
    /// No progress and no messages but errors
    #[arg(short, long)]
    pub quiet: bool,
}

impl RunOptions {
    /// What all lights of a scene share.
    pub fn index(&self, scene: &Scene) -> SceneIndex {
        let index = SceneIndex::new(scene);
        if self.cull == Culling::ClosedSolids {
            // Now, so that the first light's time does not hold it.
            index.solids(scene);
        }
        index
    }

    /// What testers of one light are built from, for the surfaces that a camera sees, within what memory is left.
    pub fn build_input<'a>(
        &self,
        scene: &'a Scene,
        index: &'a SceneIndex,
        light: LightPosition,
        memory: MemoryLimit,
    ) -> BuildInput<'a> {
        BuildInput {
            resolution: self.resolution,
            culling: self.cull,
            object_coherence: if self.object_coherence {
                ObjectCoherence::LastOccluder
            } else {
                ObjectCoherence::Off
            },
            bounding_volumes: self.volume_threshold.map_or(VolumeThreshold::Off, VolumeThreshold::MoreThan),
            shadow_buffer: self.shadow_buffer(),
            embree: EmbreeSettings { epsilon: self.embree_epsilon, threads: rayon::current_num_threads() },
            memory,
            instruction_set: self.isa.unwrap_or_else(InstructionSet::best),
            ..BuildInput::new(scene, index, light)
        }
    }

    /// How shadow-buffers are made and looked up.
    pub fn shadow_buffer(&self) -> ShadowBufferSettings {
        ShadowBufferSettings {
            rows: self.shadow_buffer_size[0],
            columns: self.shadow_buffer_size[1],
            lookup: self.shadow_buffer_lookup,
            filter: self.shadow_buffer_filter,
            bias: self.shadow_buffer_bias.map_or(DepthBias::CellWidth, DepthBias::Share),
        }
    }

    /// Tells those options that decide answers and are not as usual, by name and value.
    pub fn answer_options(&self, option: &mut impl FnMut(&str, Option<String>)) {
        let usual = ShadowBufferSettings::default();
        let settings = self.shadow_buffer();
        if self.embree_epsilon != EmbreeSettings::default().epsilon {
            option("embree-epsilon", Some(format!("{:?}", self.embree_epsilon)));
        }
        if (settings.rows, settings.columns) != (usual.rows, usual.columns) {
            option("shadow-buffer-size", Some(format!("{}x{}", settings.rows, settings.columns)));
        }
        if settings.lookup != usual.lookup {
            let lookup = if settings.lookup == Lookup::Identity { "identity" } else { "depth" };
            option("shadow-buffer-lookup", Some(lookup.into()));
        }
        if settings.filter != usual.filter {
            option("shadow-buffer-filter", Some(settings.filter.cells().to_string()));
        }
        if let Some(bias) = self.shadow_buffer_bias {
            option("shadow-buffer-bias", Some(format!("{bias:?}")));
        }
    }

    /// The most memory that anything may need.
    pub fn memory_limit(&self) -> MemoryLimit {
        self.memory_limit.unwrap_or_else(MemoryLimit::of_this_machine)
    }

    /// The pool that everything parallel runs in.
    ///
    /// # Errors
    /// If the system refuses the threads.
    pub fn pool(&self) -> Result<rayon::ThreadPool> {
        thread_pool(self.threads)
    }
}

/// A pool of so many threads. If it is not said how many, they are as many as Slurm has given the task, and at most those
/// that the process may run at once by its control group and mask.
///
/// # Errors
/// If the system refuses the threads.
pub fn thread_pool(threads: Option<u16>) -> Result<rayon::ThreadPool> {
    let of_task = || {
        let most = std::thread::available_parallelism().map_or(usize::MAX, NonZero::get);
        // 0 is all, as rayon counts them.
        slurm::threads().map_or(0, |threads| threads.min(most))
    };
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.map_or_else(of_task, usize::from))
        .build()
        .map_err(|e| Error::Usage(format!("--threads: {e}")))
}

/// The most pixels of an image: their indices are 32 bits, and 2^28 are 40 GB of planes already.
const MOST_PIXELS: u64 = 1 << 28;

/// A size in pixels, such as `1920x1080`.
pub fn parse_size(text: &str) -> std::result::Result<ImageSize, String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let (width, height): (u32, u32) = sides.ok_or("expected WIDTHxHEIGHT in pixels, such as 1920x1080")?;
    ImageSize::checked(width, height, MOST_PIXELS)
}

fn parse_point(text: &str) -> std::result::Result<Vec3, String> {
    let numbers: Option<Vec<f32>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) if [x, y, z].iter().all(|n: &f32| n.is_finite()) => Ok(Vec3::new(x, y, z)),
        _ => Err("expected three finite numbers X,Y,Z".into()),
    }
}

/// Reads a set of instructions that this machine has.
///
/// # Errors
/// The names of those.
pub fn parse_instruction_set(text: &str) -> std::result::Result<InstructionSet, String> {
    let there = || InstructionSet::ALL.into_iter().filter(|set| set.is_available());
    there().find(|set| set.name() == text).ok_or_else(|| {
        let names: Vec<_> = there().map(InstructionSet::name).collect();
        format!("this machine has {}", names.join(", "))
    })
}

pub fn parse_resolution(text: &str) -> std::result::Result<Resolution, String> {
    match text.parse() {
        _ if text == "auto" => Ok(Resolution::Auto),
        Ok(cells @ 1..=crate::shadow::light_buffer::MOST_CELLS) => Ok(Resolution::Cells(cells)),
        _ => Err("expected auto or a number from 1 to 4096".into()),
    }
}

fn parse_cells(text: &str) -> std::result::Result<[u32; 2], String> {
    let sides = text.split_once('x').map(|(rows, columns)| [rows, columns].map(|n| n.parse().ok()));
    match sides {
        Some([Some(rows), Some(columns)]) if Sphere::new(rows, columns).is_some() => Ok([rows, columns]),
        _ => Err("expected ROWSxCOLUMNS, such as 400x800, with 1 to 65536 each".into()),
    }
}

fn parse_lookup(text: &str) -> std::result::Result<Lookup, String> {
    match text {
        "identity" => Ok(Lookup::Identity),
        "depth" => Ok(Lookup::Depth),
        _ => Err("expected identity or depth".into()),
    }
}

fn parse_filter(text: &str) -> std::result::Result<FilterWidth, String> {
    let cells = text.parse().ok().and_then(FilterWidth::new);
    cells.ok_or_else(|| format!("expected an odd number from 1 to {}", FilterWidth::MOST))
}

fn parse_bias(text: &str) -> std::result::Result<f32, String> {
    match text.parse() {
        Ok(bias) if (0.0..1.0).contains(&bias) => Ok(bias),
        _ => Err("expected a number in [0, 1)".into()),
    }
}

fn parse_culling(text: &str) -> std::result::Result<Culling, String> {
    match text {
        "off" => Ok(Culling::Off),
        "solids" => Ok(Culling::ClosedSolids),
        _ => Err("expected off or solids".into()),
    }
}

fn parse_stops(text: &str) -> std::result::Result<f32, String> {
    match text.parse() {
        Ok(stops) if (-100.0..=100.0).contains(&stops) => Ok(stops),
        _ => Err("expected a number of stops from -100 to 100".into()),
    }
}

pub fn parse_epsilon(text: &str) -> std::result::Result<f32, String> {
    match text.parse() {
        Ok(epsilon) if (0.0..0.5).contains(&epsilon) => Ok(epsilon),
        _ => Err("expected a number in [0, 0.5)".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_checked_before_memory_is_asked_for() {
        assert_eq!(parse_size("1920x1080"), Ok(ImageSize { width: 1920, height: 1080 }));
        for bad in ["", "10", "0x5", "5x0", "-1x5", "100000x100000", "1x2x3", "9999999999x1"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn points_need_three_finite_numbers() {
        assert_eq!(parse_point("1,-2.5, 3"), Ok(Vec3::new(1.0, -2.5, 3.0)));
        for bad in ["", "1,2", "1,2,3,4", "a,b,c", "1,2,nan", "1,2,1e99"] {
            assert!(parse_point(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn shadow_buffers_have_sizes_filters_and_biases_in_range() {
        assert_eq!(parse_cells("400x800"), Ok([400, 800]));
        for bad in ["", "400", "0x800", "400x0", "65537x1", "-1x5", "1x2x3", "99999999999x1"] {
            assert!(parse_cells(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_filter("3"), Ok(FilterWidth::new(3).unwrap()));
        assert!(["0", "2", "65", "-1", "x"].iter().all(|bad| parse_filter(bad).is_err()));
        assert!(parse_lookup("depth").is_ok() && parse_lookup("Depth").is_err());
        assert!(parse_bias("0").is_ok() && parse_bias("1").is_err() && parse_bias("nan").is_err());
    }

    #[test]
    fn resolutions_epsilons_and_stops_stay_in_range() {
        assert_eq!(parse_resolution("auto"), Ok(Resolution::Auto));
        assert_eq!(parse_resolution("4096"), Ok(Resolution::Cells(4096)));
        assert!(parse_resolution("0").is_err() && parse_resolution("4097").is_err());
        assert!(parse_stops("-1.5").is_ok() && parse_stops("nan").is_err() && parse_stops("inf").is_err());
        assert!(parse_epsilon("0").is_ok() && parse_epsilon("0.5").is_err() && parse_epsilon("nan").is_err());
    }
}
