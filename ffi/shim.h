/*
 * The one header that bindgen reads. Plain C types only: no type of Embree appears here, so the Rust side is the same
 * text whether the shim was compiled against Embree 3 or Embree 4. See README.md in this folder.
 *
 * Every function returns LB_OK or LB_FAILED, and fills `error` if it fails. Pointers are never null unless said.
 * Every function leaves the floating-point control and status word (MXCSR) as the caller had it.
 */
#ifndef LIGHTBUFFER_SHIM_H
#define LIGHTBUFFER_SHIM_H

#include <stddef.h>
#include <stdint.h>

enum { LB_OK = 0, LB_FAILED = 1 };

/* `LbRay.excluded` of a ray that no primitive is excluded for. */
#define LB_NO_PRIMITIVE 0xFFFFFFFFu

/* Scene flags. */
enum {
    /* Watertight traversal and intersection. */
    LB_SCENE_ROBUST = 1,
    /* Let a ray pass through its excluded primitive. Triangles need a filter for it, which costs time even where it
       changes nothing. */
    LB_SCENE_FILTERED = 2
};

/* `LbHoles.mask_of` of a triangle without holes. */
#define LB_NO_MASK 0xFFFFFFFFu

/* How a mask goes on beyond its sides. */
enum { LB_WRAP_REPEAT = 0, LB_WRAP_MIRRORED = 1, LB_WRAP_CLAMP = 2 };

/* Where triangles are there: a bit a texel, row by row, the lowest bit of each word first. */
typedef struct LbMask {
    uint32_t size[2];
    uint32_t wrap[2];
    const uint64_t *there;
} LbMask;

/* Masks by triangle. `coordinates` holds 6 floats a triangle: u and v of each corner. */
typedef struct LbHoles {
    const uint32_t *mask_of;
    const float *coordinates;
    const LbMask *masks;
} LbHoles;

/* Around its anchor. */
typedef struct LbSphere {
    double radius;
} LbSphere;

/* Around its anchor; the rows of the matrix that takes it to the unit sphere. */
typedef struct LbEllipsoid {
    double to_unit[3][3];
} LbEllipsoid;

/* The wall between the anchor and the end of the axis, where the radius has grown by `growth`; no caps. */
typedef struct LbCone {
    double axis[3];
    double base_radius;
    double growth;
} LbCone;

/* Flat and round, around its anchor. */
typedef struct LbDisc {
    double normal[3];
    double radius;
} LbDisc;

/* Through its anchor, without end. */
typedef struct LbPlane {
    double normal[3];
} LbPlane;

/* Within its bounds, relative to its anchor: coefficients of xx, yy, zz, xy, yz, zx; of x, y, z; and the constant. */
typedef struct LbQuadric {
    double second[6];
    double first[3];
    double constant;
} LbQuadric;

/* What a curved surface is beside its anchor. Double precision holds the floats of the scene as they are. */
typedef union LbSurface {
    LbSphere sphere;
    LbEllipsoid ellipsoid;
    LbCone cone;
    LbDisc disc;
    LbPlane plane;
    LbQuadric quadric;
} LbSurface;

/* Kinds of curved surfaces, each named after the member of LbSurface that it uses. */
enum { LB_SPHERE = 0, LB_ELLIPSOID = 1, LB_CONE = 2, LB_DISC = 3, LB_PLANE = 4, LB_QUADRIC = 5 };

/* A curved surface. */
typedef struct LbCurved {
    /* LB_SPHERE and so on. */
    uint32_t kind;
    /* 1 if light passes through: it blocks no ray, and is among what a ray crosses. */
    uint32_t transparent;
    /* A box around it, closed, of coordinates in Embree's range. */
    float low[3];
    float high[3];
    double anchor[3];
    LbSurface surface;
} LbCurved;

/*
 * What a scene is made of. Everything that is pointed at must stay where it is, unchanged, until lb_scene_free.
 * Primitives are numbered: all triangles, and after them all curved surfaces.
 */
typedef struct LbParts {
    /* 3 floats a vertex and one more float at the very end, because Embree reads 16 bytes at the last vertex. */
    const float *vertices;
    size_t vertex_count;
    /* 3 indices a triangle, all below `vertex_count`. */
    const uint32_t *triangles;
    size_t triangle_count;
    /* May be null; a ray then passes through no triangle. */
    const LbHoles *holes;
    /* May be null; else for each triangle 1 if light passes through it. */
    const uint8_t *transparent;
    const LbCurved *curved;
    size_t curved_count;
} LbParts;

/* Build quality. */
enum { LB_BUILD_LOW = 0, LB_BUILD_MEDIUM = 1, LB_BUILD_HIGH = 2 };

/* How many rays go to Embree in one call: a packet of so many, or a stream of up to so many. */
enum {
    LB_PACKET_1 = 1,
    LB_PACKET_4 = 4,
    LB_PACKET_8 = 8,
    LB_PACKET_16 = 16,
    /* Only where LbDeviceInfo.streams is 1. */
    LB_STREAM = 256
};

/* Query flags. */
enum {
    /* The rays of a batch lie close together in space and direction: a promise about speed, not about answers. */
    LB_QUERY_COHERENT = 1,
    /* Denormals count as zero during the queries; without it they do not, whatever the caller's mode. */
    LB_QUERY_FLUSH_DENORMALS = 2
};

/* What went wrong first. `text` is one line, ends in 0 and is cut if it is longer. */
typedef struct LbError {
    char text[256];
} LbError;

/* Embree's device, where its errors are stored and how much memory it holds. */
typedef struct LbDevice LbDevice;

/* A committed scene. It refers to buffers of the caller and to its device. */
typedef struct LbScene LbScene;

/* What the library that was loaded says of itself; all but the version are 0 or 1. */
typedef struct LbDeviceInfo {
    uint32_t version_major;
    uint32_t version_minor;
    uint32_t version_patch;
    /* Whether packets of 4, 8 and 16 have traversal code of their own on this machine. */
    uint32_t native_packet_4;
    uint32_t native_packet_8;
    uint32_t native_packet_16;
    /* Whether rays may be asked as streams: Embree 3 alone has them, if it was built so. */
    uint32_t streams;
    /* Whether LB_QUERY_FLUSH_DENORMALS does anything: on x86-64 alone. */
    uint32_t flushes_denormals;
} LbDeviceInfo;

/* The segment origin + t * direction, t_near <= t <= t_far, in the space of the vertices. */
typedef struct LbRay {
    float origin[3];
    float t_near;
    float direction[3];
    float t_far;
    /*
     * The primitive that this ray starts on, or LB_NO_PRIMITIVE. Read only in a filtered scene. A triangle or another
     * flat surface then never blocks it. A curved one is taken as passing through the origin exactly: it is met where
     * the line meets it for the other time.
     */
    uint32_t excluded;
} LbRay;

/* A transparent primitive that a ray meets. The same may be there several times, always with the same `times`. */
typedef struct LbCrossing {
    /* Index of the ray. */
    uint32_t ray;
    uint32_t primitive;
    /* At how many points. */
    uint32_t times;
} LbCrossing;

/* A device that builds with `threads` threads; 0 leaves the number to Embree. */
uint32_t lb_device_new(uint32_t threads, LbDevice **device, LbError *error);
/* Scenes of the device must be gone. */
uint32_t lb_device_free(LbDevice *device, LbError *error);
uint32_t lb_device_info(const LbDevice *device, LbDeviceInfo *info, LbError *error);
/* Bytes that Embree holds for all scenes of the device, as its memory monitor reports them. */
uint32_t lb_device_bytes(LbDevice *device, int64_t *bytes, LbError *error);

/* Builds a scene. `parts` and the LbHoles in it are copied; what they point at is not. */
uint32_t lb_scene_new(LbDevice *device, const LbParts *parts, uint32_t quality, uint32_t flags, LbScene **scene,
                      LbError *error);
uint32_t lb_scene_free(LbScene *scene, LbError *error);

/*
 * answers[i] = 1 if rays[i] meets a primitive that is not transparent, else 0, for i < count. `grouping` is LB_PACKET_1
 * and so on or LB_STREAM; one that is unknown or that this Embree lacks is an error, and then no answer is written. Any
 * number of threads may query one scene at the same time.
 */
uint32_t lb_scene_occluded(const LbScene *scene, const LbRay *rays, size_t count, uint32_t grouping, uint32_t flags,
                           uint8_t *answers, LbError *error);

/*
 * As lb_scene_occluded, and tells which transparent primitives each ray meets, in no order: of a ray that is blocked
 * some of them, of any other all. `found` becomes their number; of more than `capacity` the rest is counted and not
 * written.
 */
uint32_t lb_scene_crossed(const LbScene *scene, const LbRay *rays, size_t count, uint32_t grouping, uint32_t flags,
                          uint8_t *answers, LbCrossing *crossings, size_t capacity, size_t *found, LbError *error);

/*
 * primitives[i] = the triangle that the ray from `origin` in the direction of the 3 floats directions[3 * i] meets first,
 * or LB_NO_PRIMITIVE, for i < count. Of a scene of triangles alone, without holes; light that passes through one changes
 * nothing. `grouping` and threads as in lb_scene_occluded.
 */
uint32_t lb_scene_first_hits(const LbScene *scene, const float *origin, const float *directions, size_t count,
                             uint32_t grouping, uint32_t flags, uint32_t *primitives, LbError *error);

#endif
