//! Meshes, and rays whose answers follow from arithmetic alone.

use lightbuffer::embree::ShadowRay;

/// The whole segment between two points; nothing excluded.
pub fn segment(from: [f32; 3], to: [f32; 3]) -> ShadowRay {
    let direction = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
    ShadowRay { origin: from, t_near: 0.0, direction, t_far: 1.0, excluded: ShadowRay::NO_PRIMITIVE }
}

/// Numbers from a fixed sequence (SplitMix64).
pub struct Numbers(pub u64);

impl Numbers {
    /// From 0 to 1.
    pub fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 40) as f32 / (1 << 24) as f32
    }

    pub fn point(&mut self) -> [f32; 3] {
        [self.next(), self.next(), self.next()]
    }
}

/// Six times the volume of a tetrahedron.
fn volume(a: [f32; 3], b: [f32; 3], c: [f32; 3], d: [f32; 3]) -> f64 {
    let from_d = |p: [f32; 3]| [0, 1, 2].map(|k| f64::from(p[k]) - f64::from(d[k]));
    let (a, b, c) = (from_d(a), from_d(b), from_d(c));
    a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Whether the segment crosses the triangle; `None` if it is too close to tell without exact arithmetic.
fn crosses(from: [f32; 3], to: [f32; 3], [a, b, c]: [[f32; 3]; 3]) -> Option<bool> {
    let clear = 1e-5;
    let ends = [volume(a, b, c, from), volume(a, b, c, to)];
    let edges = [volume(from, to, a, b), volume(from, to, b, c), volume(from, to, c, a)];
    let apart = |v: &[f64]| v.iter().any(|&x| x > clear) && v.iter().any(|&x| x < -clear);
    let together = |v: &[f64]| v.iter().all(|&x| x > clear) || v.iter().all(|&x| x < -clear);
    if together(&ends) || apart(&edges) {
        Some(false)
    } else if apart(&ends) && together(&edges) {
        Some(true)
    } else {
        None
    }
}

/// A soup of triangles and rays through it whose answers are beyond doubt; a third excludes the one triangle it meets.
pub struct Soup {
    pub vertices: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
    pub rays: Vec<ShadowRay>,
    pub blocked: Vec<bool>,
    pub blocked_without_excluded: Vec<bool>,
}

impl Soup {
    /// Whether a segment crosses any of the triangles; `None` if it is too close to tell.
    pub fn crossed_by(&self, from: [f32; 3], to: [f32; 3]) -> Option<bool> {
        let each = (0..self.triangles.len()).map(|triangle| self.crossed_one(triangle, from, to));
        each.collect::<Option<Vec<bool>>>().map(|crossings| crossings.contains(&true))
    }

    /// Whether a segment crosses this triangle; `None` if it is too close to tell.
    pub fn crossed_one(&self, triangle: usize, from: [f32; 3], to: [f32; 3]) -> Option<bool> {
        crosses(from, to, self.triangles[triangle].map(|i| self.vertices[i as usize]))
    }
}

pub fn soup(triangle_count: u32, ray_count: usize) -> Soup {
    let mut numbers = Numbers(7);
    let mut vertices = Vec::new();
    for _ in 0..triangle_count {
        let centre = numbers.point();
        for _ in 0..3 {
            let offset = numbers.point();
            vertices.push([0, 1, 2].map(|k| centre[k] + 0.3 * (offset[k] - 0.5)));
        }
    }
    let triangles: Vec<[u32; 3]> = (0..triangle_count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mut soup =
        Soup { vertices, triangles, rays: vec![], blocked: vec![], blocked_without_excluded: vec![] };
    while soup.rays.len() < ray_count {
        let (from, to) = (numbers.point(), numbers.point());
        let corners = |triangle: &[u32; 3]| triangle.map(|i| soup.vertices[i as usize]);
        let crossings: Option<Vec<bool>> =
            soup.triangles.iter().map(|triangle| crosses(from, to, corners(triangle))).collect();
        let Some(crossings) = crossings else { continue };
        let met = crossings.iter().filter(|&&met| met).count();
        let first = crossings.iter().position(|&met| met);
        let excluded = match first {
            Some(first) if soup.rays.len().is_multiple_of(3) => first as u32,
            _ => ShadowRay::NO_PRIMITIVE,
        };
        let ray = ShadowRay { excluded, ..segment(from, to) };
        soup.rays.push(ray);
        soup.blocked.push(met > 0);
        let passed = usize::from(excluded != ShadowRay::NO_PRIMITIVE);
        soup.blocked_without_excluded.push(met > passed);
    }
    soup
}

/// A closed surface around the origin: rings of `2 * rings` vertices between two poles, with an uneven radius.
pub fn bumpy_ball(rings: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let around = 2 * rings;
    let vertex = |ring: u32, k: u32| {
        let radius = 1.0 + 0.1 * ((7 * ring + 3 * k) as f32).sin();
        let polar = std::f32::consts::PI * ring as f32 / (rings + 1) as f32;
        let azimuth = std::f32::consts::PI * k as f32 / rings as f32;
        [polar.sin() * azimuth.cos(), polar.sin() * azimuth.sin(), polar.cos()].map(|x| radius * x)
    };
    let mut vertices = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    vertices.extend((1..=rings).flat_map(|ring| (0..around).map(move |k| vertex(ring, k))));
    let index = |ring: u32, k: u32| 2 + (ring - 1) * around + k % around;
    let mut triangles = Vec::new();
    for k in 0..around {
        triangles.push([0, index(1, k), index(1, k + 1)]);
        triangles.push([1, index(rings, k + 1), index(rings, k)]);
        for ring in 1..rings {
            triangles.push([index(ring, k), index(ring + 1, k), index(ring + 1, k + 1)]);
            triangles.push([index(ring, k), index(ring + 1, k + 1), index(ring, k + 1)]);
        }
    }
    (vertices, triangles)
}
