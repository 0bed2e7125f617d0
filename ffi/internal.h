/* What the C files share; nobody else includes this. */
#ifndef LIGHTBUFFER_INTERNAL_H
#define LIGHTBUFFER_INTERNAL_H

#include "shim.h"

#include <stdatomic.h>
#include <stdbool.h>

#if LB_EMBREE_MAJOR == 4
#include <embree4/rtcore.h>
#elif LB_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#error "LB_EMBREE_MAJOR must be 3 or 4"
#endif

#if RTC_VERSION_MAJOR != LB_EMBREE_MAJOR
#error "the headers are not of the major version that LB_EMBREE_MAJOR says"
#endif

struct LbDevice {
    RTCDevice handle;
    _Atomic int64_t bytes;
    /* First error that Embree raised on a thread of its own: written by whoever moves `stray_state` from 0 to 1. */
    _Atomic int stray_state;
    LbError stray;
};

struct LbScene {
    LbDevice *device;
    RTCScene handle;
    /* Whether rays exclude primitives. */
    bool filtered;
    /* Whether triangles have holes, and which. */
    bool has_holes;
    LbHoles holes;
    /* The rest of what it is made of; its `holes` is not used. */
    LbParts parts;
};

/* What a ray query is to Embree. */
#if LB_EMBREE_MAJOR == 4
typedef struct RTCRayQueryContext EmbreeContext;
#else
typedef struct RTCIntersectContext EmbreeContext;
#endif

/* Where the transparent primitives go that rays meet. */
typedef struct Collector {
    /* What the indices of rays are counted from. */
    const LbRay *first_ray;
    LbCrossing *crossings;
    size_t capacity;
    size_t found;
} Collector;

/* Embree hands a pointer to `embree` to its callbacks, which find the rest there: `embree` must come first. */
typedef struct QueryContext {
    EmbreeContext embree;
    /* The rays of this packet or stream, by ray id. */
    const LbRay *rays;
    /* Null if nobody wants to know. */
    Collector *collector;
} QueryContext;

/*
 * Rays of N lanes are arrays of 4-byte fields, one after another (rtcore_ray.h has accessors, for C++ only): field F of
 * lane i is at F * N + i.
 */
enum {
    ORIGIN_FIELD = 0,
    T_NEAR_FIELD = 3,
    DIRECTION_FIELD = 4,
    T_FAR_FIELD = 8,
    RAY_ID_FIELD = 10
};

/* The floating-point control word: MXCSR, or the C environment where there is none. */
#if defined(__x86_64__)
typedef unsigned int FloatControl;
#else
#include <fenv.h>
typedef fenv_t FloatControl;
#endif

/* Everything that a call into Embree is wrapped in. */
typedef struct Call {
    LbError *error;
    FloatControl float_control;
} Call;

/* Every function of shim.h begins with the one and returns the other. `device` may be null. */
Call lb_begin_call(LbError *error);
uint32_t lb_end_call(Call call, LbDevice *device);
/* An error of the shim's own; one that Embree reported before it wins. */
void lb_fail(Call call, const char *text);
/*
 * Flushes denormals on this thread, in results and operands, or computes with them; lb_end_call undoes it. Returns
 * whether there is a choice: where there is none, the mode stays that of the caller.
 */
bool lb_choose_denormals(bool flush);
/* Whether Embree takes streams of rays. */
bool lb_has_streams(const LbDevice *device);
/* What the device says of itself. */
uint32_t lb_property(const LbDevice *device, enum RTCDeviceProperty name);

/* The filter of a mesh with LB_SCENE_FILTERED, holes or transparent triangles; its user data is the LbScene. */
void lb_reject_hits(const struct RTCFilterFunctionNArguments *arguments);
/* Writes down that a ray meets a transparent primitive, if somebody wants to know. */
void lb_collect(const QueryContext *context, uint32_t ray_id, size_t primitive, unsigned times);

/* The geometry of a scene's curved surfaces; null if it cannot be made. The caller owns it. */
RTCGeometry lb_new_curved(Call call, LbScene *scene);

#endif
