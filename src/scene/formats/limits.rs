//! How much a scene file may ask for.
//!
//! Memory is bounded by these numbers and not by what a file claims: a few hundred bytes can declare, by
//! shared meshes or by counts alone, more than any machine holds.

/// The largest scene file, in bytes.
pub const MAX_SCENE_BYTES: u64 = 2 << 30;

/// The most bytes that all files named by one scene may hold together.
pub const MAX_REFERENCED_BYTES: u64 = 2 << 30;

/// The most bytes of material libraries (.mtl): an entry of nine bytes becomes a material of hundreds.
pub const MAX_MATERIAL_BYTES: u64 = 16 << 20;

/// The most vertices of a PLY file.
pub const MAX_VERTICES: u64 = 1 << 28;

/// The most bytes of a PLY file's header: a property of sixteen bytes becomes a record of a hundred.
pub const MAX_PLY_HEADER_BYTES: usize = 1 << 20;

/// The most triangles after instancing, before degenerate ones are dropped.
pub const MAX_TRIANGLES: u64 = 1 << 26;

/// The most curved surfaces: one of nine bytes becomes a record of eighty.
pub const MAX_CURVED: u64 = 1 << 24;

/// The most objects; `object_id` image channels hold them exactly up to 2^24.
pub const MAX_OBJECTS: u64 = 1 << 20;

/// The most lights; each costs a pass over the image, and a channel in it.
pub const MAX_LIGHTS: usize = 1 << 14;

/// The most pixels of the image that a camera brings; the command line may ask for more.
pub const MAX_CAMERA_PIXELS: u64 = 1 << 24;

/// The most generations in a tree of nodes.
pub const MAX_NODE_DEPTH: usize = 1 << 10;

/// The most `{` in glTF's JSON; the shortest, `{}`, can become a node of some hundred bytes.
pub const MAX_JSON_OBJECTS: usize = 1 << 21;

/// The most values in glTF's JSON, counted by what separates them.
pub const MAX_JSON_VALUES: usize = 1 << 26;

/// The most elements of a glTF accessor without bytes of its own, all zero but for what is sparse.
pub const MAX_ZEROS: u64 = 1 << 22;

/// The most joints of all skins that a glTF scene shows.
pub const MAX_JOINTS: usize = 1 << 20;

/// The most keys of all animations of a scene, of all properties together.
pub const MAX_KEYS: u64 = 1 << 22;

/// The most times that a morph target or a joint moves a vertex, over all instances.
pub const MAX_MOVES: u64 = 1 << 28;

/// The most texels of one image; each takes up to eight bytes while it is read, whatever the file's size.
pub const MAX_IMAGE_TEXELS: u64 = 1 << 26;

/// The most texels of all masks that a scene reads; each takes a bit for good.
pub const MAX_ALL_TEXELS: u64 = 1 << 28;

/// The most `f` lines of an OBJ file; the shortest becomes a record of a hundred bytes.
pub const MAX_FACES: usize = 1 << 24;

/// The most corners on all `f` lines of an OBJ file together.
pub const MAX_CORNERS: usize = 1 << 26;

/// The most materials of an NFF file: one of fifteen bytes becomes a record of a hundred.
pub const MAX_FILLS: usize = 1 << 20;

/// The most corners of a polygon that is not strictly convex: cutting it up takes quadratic time.
pub const MAX_CONCAVE_CORNERS: usize = 1 << 12;

/// The most bytes of all TOML files of a scene: one byte can take a hundred while it is parsed.
pub const MAX_TOML_BYTES: u64 = 16 << 20;

/// The most generations of TOML files that include each other.
pub const MAX_INCLUDE_DEPTH: usize = 16;

/// The most times that a TOML scene places a file.
pub const MAX_PLACEMENTS: u64 = 1 << 20;

/// The most cameras of a TOML scene.
pub const MAX_CAMERAS: u64 = 1 << 16;
