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

/* `LbRay.excluded` of a ray that no triangle is excluded for. */
#define LB_NO_TRIANGLE 0xFFFFFFFFu

/* Scene flags. */
enum {
    /* Watertight traversal and intersection. */
    LB_SCENE_ROBUST = 1,
    /* Register the filter that makes a ray pass through its excluded triangle. Costs time even where it changes nothing. */
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

/* A committed scene of one triangle mesh. It refers to buffers of the caller and to its device. */
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
    /* Index of the triangle that never blocks this ray, or LB_NO_TRIANGLE. Read only in a filtered scene. */
    uint32_t excluded;
} LbRay;

/* A device that builds with `threads` threads; 0 leaves the number to Embree. */
uint32_t lb_device_new(uint32_t threads, LbDevice **device, LbError *error);
/* Scenes of the device must be gone. */
uint32_t lb_device_free(LbDevice *device, LbError *error);
uint32_t lb_device_info(const LbDevice *device, LbDeviceInfo *info, LbError *error);
/* Bytes that Embree holds for all scenes of the device, as its memory monitor reports them. */
uint32_t lb_device_bytes(LbDevice *device, int64_t *bytes, LbError *error);

/*
 * Builds a scene of one mesh. `vertices` holds 3 floats a vertex and one more float at the very end, because Embree
 * reads 16 bytes at the last vertex; `triangles` holds 3 indices a triangle, all below `vertex_count`. `holes` may be null;
 * a ray then passes through no triangle. What it points at and the two arrays must stay where they are, unchanged, until
 * lb_scene_free.
 */
uint32_t lb_scene_new(LbDevice *device, const float *vertices, size_t vertex_count, const uint32_t *triangles,
                      size_t triangle_count, const LbHoles *holes, uint32_t quality, uint32_t flags, LbScene **scene,
                      LbError *error);
uint32_t lb_scene_free(LbScene *scene, LbError *error);

/*
 * answers[i] = 1 if rays[i] meets a triangle, else 0, for i < count. `grouping` is LB_PACKET_1 and so on or LB_STREAM;
 * one that is unknown or that this Embree lacks is an error, and then no answer is written. Any number of threads may
 * query one scene at the same time.
 */
uint32_t lb_scene_occluded(const LbScene *scene, const LbRay *rays, size_t count, uint32_t grouping, uint32_t flags,
                           uint8_t *answers, LbError *error);

#endif
