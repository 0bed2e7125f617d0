//! Curved surfaces, objects of several parts, materials and textures of the project's own format.

use crate::fixtures::Folder;
use crate::gltf_parts::png;
use crate::refused;
use lightbuffer::scene::formats;

const MESH: &str = "[[mesh]]\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n";

/// Asserts that a text that begins in line 5 of a file, after a mesh, is refused with the words.
#[track_caller]
fn elements_refused(text: &str, words: &[&str]) {
    let folder = Folder::new();
    refused(&folder.write("bad.toml", format!("version = 1\n{MESH}{text}\n")), words);
}

#[test]
fn surfaces_that_are_none() {
    let sphere = |rest: &str, words: &[&str]| {
        elements_refused(&format!("[[sphere]]\nname = 'ball'\ncentre = [0, 0, 0]\n{rest}"), words);
    };
    sphere("", &["bad.toml:5: missing field `radius`"]);
    for radius in ["0", "-1", "1e-60", "1e39"] {
        let words = "bad.toml:5: sphere 1 `ball`: expected a radius above 0 and in the range";
        sphere(&format!("radius = {radius}"), &[words]);
    }
    sphere("radius = nan", &["bad.toml:8: expected a finite number, found NaN"]);
    sphere("radius = [1, 1, 1]", &["bad.toml:8: "]);
    sphere("radius = 1\nradii = 1", &["bad.toml:9: unknown field `radii`"]);
    sphere("radius = 1\nmaterial = 'none'", &["bad.toml:9: no material `none`"]);
    let ellipsoid = |rest: &str, words: &str| {
        let text = format!("[[ellipsoid]]\ncentre = [0, 0, 0]\n{rest}");
        elements_refused(&text, &["bad.toml:5: ellipsoid 1: ", words]);
    };
    ellipsoid("", "expected `radii` or `axes`, found neither");
    ellipsoid("radii = [1, 0, 1]", "expected radii above 0, found [1.0, 0.0, 1.0]");
    ellipsoid("radii = [1, 1e-60, 1]", "expected radii above 0");
    ellipsoid("radii = [1, 1, 1]\naxes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]", "found both");
    let ends = "base = [0, 0, 0]\napex = [0, 1, 0]\n";
    elements_refused(
        &format!("[[cone]]\n{ends}base_radius = 0"),
        &["bad.toml:5: cone 1: expected a radius above 0 at one end"],
    );
    elements_refused(
        &format!("[[cone]]\n{ends}base_radius = 1\napex_radius = -1"),
        &["bad.toml:5: cone 1: "],
    );
    elements_refused(&format!("[[cylinder]]\n{ends}radius = -1"), &["bad.toml:5: cylinder 1: "]);
    let flat = "[[disc]]\ncentre = [0, 0, 0]\nradius = 1\nnormal = [0, 0, 0]";
    elements_refused(flat, &["bad.toml:8: expected a direction, found zero"]);
    let plane = "[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 1e-60, 0]";
    elements_refused(plane, &["bad.toml:7: expected a direction, found zero"]);
    let quadric = |rest: &str, words: &[&str]| {
        elements_refused(&format!("[[quadric]]\nlow = [0, 0, 0]\n{rest}"), words);
    };
    quadric("high = [1, 1, 0]", &["bad.toml:5: quadric 1: expected `low` below `high`"]);
    quadric("high = [1, 1, 1]\nconstant = 1e39", &["bad.toml:5: quadric 1: expected a number in the range"]);
    quadric("high = [1, 1, 1]\nsquares = [1e39, 0, 0]", &["bad.toml:8: expected numbers in the range"]);
    quadric("", &["bad.toml:5: missing field `high`"]);
}

#[test]
fn surfaces_without_area_are_dropped_and_never_silent() {
    let folder = Folder::new();
    let text = format!(
        "version = 1\n{MESH}[[quadric]]\nlow = [0, 0, 0]\nhigh = [1, 1, 1]\nconstant = 3\n\
         [[ellipsoid]]\ncentre = [0, 0, 0]\naxes = [[1, 0, 0], [0, 1, 0], [1, 1, 0]]\n\
         [[cylinder]]\nbase = [1, 0, 0]\napex = [1, 0, 0]\nradius = 1\n\
         [[sphere]]\ncentre = [0, 0, 0]\nradius = 1e-30\ntransform = {{ scale = 1e-30 }}\n\
         [[sphere]]\ncentre = [1, 0, 0]\nradius = 1\ntransform = {{ scale = 1e300 }}\n\
         [[sphere]]\ncentre = [1, 0, 0]\nradius = 1\n"
    );
    let scene = formats::load(&folder.write("some.toml", text)).unwrap();
    assert_eq!((scene.curved.len(), scene.dropped.curved, scene.objects.len()), (1, 5, 7));
    // Three of the file, two more once they were moved.
    let dropped = scene.warnings.iter().filter(|w| w.contains("curved surfaces")).collect::<Vec<_>>();
    assert!(dropped[0].contains("dropped 3 curved") && dropped[1].contains("dropped 2"), "{dropped:?}");
}

#[test]
fn transforms_that_a_surface_cannot_take() {
    let ends = "base = [0, 0, 0]\napex = [0, 1, 0]\nradius = 1\n";
    let uneven = "transform = { scale = [1, 2, 1] }";
    elements_refused(
        &format!("[[cylinder]]\nname = 'pipe'\n{ends}{uneven}"),
        &["bad.toml:10: cylinder 1 `pipe`: a cylinder or cone can be turned, moved and scaled evenly alone"],
    );
    let disc = "[[disc]]\nobject = 'lid'\ncentre = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = 1\n";
    elements_refused(&format!("{disc}{uneven}"), &["bad.toml:10: disc 1 `lid`: a disc can be turned"]);
    let quadric = "[[quadric]]\nsquares = [1, 1, 1]\nlow = [0, 0, 0]\nhigh = [1, 1, 1]\n";
    let turned = "transform = { rotate = { axis = [0, 1, 0], degrees = 90 } }";
    elements_refused(
        &format!("{quadric}{turned}"),
        &["bad.toml:9: quadric 1: a quadric can be moved and scaled along the axes alone"],
    );
    // The same by what includes it.
    let folder = Folder::new();
    folder.write("pipe.toml", format!("version = 1\n[[cylinder]]\nname = 'pipe'\n{ends}"));
    let path = folder.write("bad.toml", format!("version = 1\n[[include]]\npath = 'pipe.toml'\n{uneven}\n"));
    refused(&path, &["pipe.toml: object pipe: a cylinder or cone can be turned"]);
}

#[test]
fn parts_that_contradict_each_other() {
    let part = |rest: &str| format!("[[sphere]]\nobject = 'cup'\ncentre = [0, 0, 0]\nradius = 1\n{rest}\n");
    let materials = "[[material]]\nname = 'a'\n[[material]]\nname = 'b'\n";
    for (one, other, key) in [
        ("name = 'a'", "name = 'b'", "name"),
        ("material = 'a'", "material = 'b'", "material"),
        ("cast_shadows = false", "cast_shadows = true", "cast_shadows"),
        ("receive_shadows = true", "receive_shadows = false", "receive_shadows"),
    ] {
        let words = format!("another `{key}` than other parts of object `cup`");
        let text = format!("{materials}{}{}{}", part(one), part(""), part(other));
        elements_refused(&text, &["bad.toml:19: sphere 3 `", &words]);
    }
}

#[test]
fn materials_out_of_range() {
    let material = |rest: &str, words: &[&str]| {
        elements_refused(&format!("[[material]]\nname = 'a'\n{rest}"), words);
    };
    material("transmittance = 2", &["bad.toml:7: expected a number from 0 to 1e0, found 2"]);
    material("transmittance = [0, -0.5, 0]", &["bad.toml:7: expected a number from 0 to 1e0, found -0.5"]);
    material("transmittance = nan", &["bad.toml:7: expected a finite number"]);
    material("mirror = 1.5", &["bad.toml:7: expected a number from 0 to 1e0, found 1.5"]);
    for index in ["0", "-1", "1e-60"] {
        let words = "bad.toml:5: material `a`: expected a refractive index above 0";
        material(&format!("transmittance = 0.5\nrefractive_index = {index}"), &[words]);
    }
    material(
        "transmittance = 0.5\nrefractive_index = 1e39",
        &["bad.toml:5: material `a`: expected a number in the range"],
    );
    material(
        "refractive_index = 1.5",
        &["bad.toml:5: material `a`: `refractive_index` is for materials with"],
    );
    material("shininess = 1e39", &["bad.toml:5: material `a`: expected a number in the range"]);
    elements_refused("[[light]]\nbackground = 1", &["bad.toml:6: unknown field `background`"]);
    let folder = Folder::new();
    let path = folder.write("bad.toml", format!("version = 1\nbackground = -1\n{MESH}"));
    refused(&path, &["bad.toml:2: expected a number from 0 to 1e30, found -1"]);
}

#[test]
fn textures_that_are_none() {
    let texture = |keys: &str, words: &str| {
        let text = format!("[[material]]\nname = 'a'\ntexture = {{ {keys} }}");
        elements_refused(&text, &["bad.toml:7: material `a`: ", words]);
    };
    texture("size = 1", "expected a texture with `checker` or `image`, found neither");
    texture("checker = 1, image = 'a.png', size = 1", "found both");
    texture("checker = 1", "expected a texture with one of `size`, `u` and `v`, and `coordinates");
    texture("checker = 1, u = [1, 0, 0]", "one of `size`");
    texture("checker = 1, size = 1, coordinates = true", "one of `size`");
    texture("checker = 1, coordinates = false", "one of `size`");
    texture("checker = 1, coordinates = true, origin = [0, 0, 0]", "`origin` is for textures with");
    texture("checker = 1, size = 1, wrap_u = 'clamp'", "`wrap_u` and `wrap_v` are for images");
    for size in ["0", "-1", "1e-60", "1e39"] {
        texture(&format!("checker = 1, size = {size}"), "expected a `size` above 0");
    }
    texture("checker = 1, u = [1, 0, 0], v = [-2, 0, 0]", "`u` and `v` to be finite and not along one line");
    texture("checker = 1, u = [1e-30, 0, 0], v = [1, 1e-30, 0]", "not along one line");
    elements_refused(
        "[[material]]\nname = 'a'\ntexture = { checker = 2, size = 1 }",
        &["bad.toml:7: expected a number"],
    );
    let by_coordinates = "[[material]]\nname = 'a'\ntexture = { checker = 1, coordinates = true }\n";
    elements_refused(
        &format!("{by_coordinates}{MESH}material = 'a'"),
        &["bad.toml:8: mesh 2: expected `texture_coordinates` for the texture of its material"],
    );
    elements_refused(
        &format!("{by_coordinates}[[sphere]]\ncentre = [0, 0, 0]\nradius = 1\nmaterial = 'a'"),
        &["bad.toml:8: sphere 1: it has no coordinates for the texture"],
    );
    elements_refused(
        &format!("{by_coordinates}[[include]]\npath = 'a.obj'\nmaterial = 'a'"),
        &["bad.toml:10: material `a`: its texture lies by coordinates"],
    );
    for (given, words) in [
        ("[[0, 0], [1, 0]]", "bad.toml:5: mesh 2: 2 texture coordinates for 3 vertices"),
        ("[[0, 0], [1, 0], [1e39, 0]]", "bad.toml:5: mesh 2: expected texture coordinates in the range"),
        ("[[0, 0], [1, 0], [nan, 0]]", "bad.toml:8: expected a finite number"),
        ("[[0, 0], [1, 0], [1]]", "bad.toml:8: expected 2 values, found 1"),
    ] {
        elements_refused(&format!("{MESH}texture_coordinates = {given}"), &[words]);
    }
}

#[test]
fn pictures_that_lie_or_lead_out() {
    let folder = Folder::new();
    let text = |name: &str| {
        format!("version = 1\n{MESH}[[material]]\nname = 'a'\ntexture = {{ image = '{name}', size = 1 }}\n")
    };
    let path = |name: &str| folder.write("scene/bad.toml", text(name));
    folder.write("secret.png", png(1, &[255]));
    for (name, words) in [
        ("../secret.png", "it leaves the scene's folder"),
        ("x/../../secret.png", "it leaves the scene's folder"),
        ("/dev/zero", "it leaves the scene's folder"),
        ("file:///etc/passwd", "expected a relative path"),
        ("", "the name is empty"),
        ("bad.toml", "it is the scene file itself"),
        ("none.png", "cannot read `none.png`"),
        (".", "expected a regular file, found a folder"),
    ] {
        refused(&path(name), &["bad.toml:7: material `a`: ", words]);
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("../secret.png", folder.path("scene/link.png")).unwrap();
        refused(&path("link.png"), &["a link leads out of the scene's folder"]);
    }
    let good = png(4, &[255; 16]);
    let header = |width: u32, height: u32| {
        let mut file = good.clone();
        file[16..20].copy_from_slice(&width.to_be_bytes());
        file[20..24].copy_from_slice(&height.to_be_bytes());
        let sum = crc(&file[12..29]);
        file[29..33].copy_from_slice(&sum.to_be_bytes());
        file
    };
    for (bytes, words) in [
        (b"GIF89a".to_vec(), "`bad.png`: expected PNG"),
        (Vec::new(), "`bad.png`: expected PNG"),
        (good[..8].to_vec(), "`bad.png`: it cannot be read as PNG"),
        (good[..good.len() / 2].to_vec(), "`bad.png`: it cannot be read as PNG"),
        (header(4, 5), "`bad.png`: it cannot be read as PNG"),
        (header(0, 4), "`bad.png`: it cannot be read as PNG"),
        (header(4096, 4096), "4096 x 4096 texels, more than "),
        (header(65536, 65536), "65536 x 65536 texels, expected at most"),
        (header(u32::MAX, u32::MAX), "`bad.png`: "),
    ] {
        folder.write("scene/bad.png", bytes);
        refused(&path("bad.png"), &["bad.toml:7: material `a`: ", words]);
    }
    for length in 0..good.len() - 12 {
        folder.write("scene/bad.png", &good[..length]);
        let _ = formats::load(&path("bad.png"));
    }
}

/// The sum that ends each chunk of a PNG file.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |s, _| if s & 1 == 1 { s >> 1 ^ 0xedb8_8320 } else { s >> 1 })
    })
}

#[test]
fn cameras_whose_axes_are_none() {
    let camera = |rest: &str, words: &str| {
        let text = format!("[[camera]]\nposition = [0, 0, 5]\n{rest}");
        elements_refused(&text, &["bad.toml:5: camera 1: ", words]);
    };
    let axes = "axes = [[1, 0, 0], [0, 1, 0], [0, 0, -1]]\n";
    camera("", "expected a `target` or `axes`, found neither");
    camera(&format!("{axes}target = [0, 0, 0]"), "expected either `target` or `axes`, found both");
    camera(&format!("{axes}up = [0, 1, 0]"), "`up` is for cameras with a `target`");
    for half in ["0", "-1"] {
        camera(&format!("{axes}half_height = {half}"), "expected `half_height` above 0");
    }
    camera(&format!("{axes}half_height = 1\nvertical_degrees = 45"), "found both");
    for axes in [
        "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
        "[[1, 0, 0], [0, 1.01, 0], [0, 0, -1]]",
        "[[1, 0, 0], [0.01, 1, 0], [0, 0, -1]]",
        "[[0, 0, 0], [0, 0, 0], [0, 0, 0]]",
        "[[1e38, 0, 0], [0, 1e38, 0], [0, 0, -1e38]]",
    ] {
        camera(&format!("axes = {axes}"), "expected `axes` to be unit vectors");
    }
}

#[test]
fn more_surfaces_than_the_limit() {
    let folder = Folder::new();
    let sphere = "[[sphere]]\nobject = 'a'\ncentre = [0, 0, 0]\nradius = 1\n";
    folder.write("0.toml", format!("version = 1\n{}", sphere.repeat(4096)));
    let path =
        folder.write("bad.toml", format!("version = 1\n{}", "[[include]]\npath = '0.toml'\n".repeat(4097)));
    refused(&path, &["bad.toml:8194: 16781312 curved surfaces, expected at most 16777216"]);
}
