/* The first hits of shim.h, for Embree 3 and Embree 4. See README.md. */

#include "internal.h"

#include <math.h>
#include <stdalign.h>
#include <string.h>

#if LB_EMBREE_MAJOR == 4
typedef struct RTCIntersectArguments FirstHitArguments;

static FirstHitArguments first_hit_arguments(EmbreeContext *context, uint32_t flags)
{
    FirstHitArguments arguments;
    rtcInitRayQueryContext(context);
    rtcInitIntersectArguments(&arguments);
    arguments.flags = flags & LB_QUERY_COHERENT ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    arguments.feature_mask = RTC_FEATURE_FLAG_TRIANGLE;
    arguments.context = context;
    return arguments;
}

#define INTERSECT_1(scene, ray, arguments) rtcIntersect1(scene, ray, arguments)
#define INTERSECT_N(width, valid, scene, packet, arguments) rtcIntersect##width(valid, scene, packet, arguments)
#else
typedef EmbreeContext *FirstHitArguments;

static FirstHitArguments first_hit_arguments(EmbreeContext *context, uint32_t flags)
{
    rtcInitIntersectContext(context);
    context->flags =
        flags & LB_QUERY_COHERENT ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

#define INTERSECT_1(scene, ray, arguments) rtcIntersect1(scene, *(arguments), ray)
#define INTERSECT_N(width, valid, scene, packet, arguments) rtcIntersect##width(valid, scene, *(arguments), packet)
#endif

/* What all rays of a call share. */
typedef struct Eye {
    const LbScene *scene;
    const float *origin;
    uint32_t flags;
} Eye;

static inline struct RTCRayHit ray_from(const Eye *eye, const float *direction)
{
    struct RTCRayHit ray;
    ray.ray.org_x = eye->origin[0];
    ray.ray.org_y = eye->origin[1];
    ray.ray.org_z = eye->origin[2];
    ray.ray.tnear = 0.0f;
    ray.ray.dir_x = direction[0];
    ray.ray.dir_y = direction[1];
    ray.ray.dir_z = direction[2];
    ray.ray.time = 0.0f;
    ray.ray.tfar = INFINITY;
    ray.ray.mask = 0xFFFFFFFFu;
    ray.ray.id = 0;
    ray.ray.flags = 0;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.primID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return ray;
}

static void first_hits_1(const Eye *eye, const float *directions, size_t count, uint32_t *primitives)
{
    EmbreeContext context;
    FirstHitArguments arguments = first_hit_arguments(&context, eye->flags);
    for (size_t i = 0; i < count; i++) {
        struct RTCRayHit ray = ray_from(eye, &directions[3 * i]);
        INTERSECT_1(eye->scene->handle, &ray, &arguments);
        primitives[i] = ray.hit.primID;
    }
}

#if LB_EMBREE_MAJOR == 3
static void first_hits_stream(const Eye *eye, const float *directions, size_t count, uint32_t *primitives)
{
    EmbreeContext context;
    FirstHitArguments arguments = first_hit_arguments(&context, eye->flags);
    struct RTCRayHit stream[LB_STREAM];
    for (size_t first = 0; first < count; first += LB_STREAM) {
        const unsigned length = count - first < LB_STREAM ? (unsigned)(count - first) : LB_STREAM;
        for (unsigned i = 0; i < length; i++)
            stream[i] = ray_from(eye, &directions[3 * (first + i)]);
        rtcIntersect1M(eye->scene->handle, arguments, stream, length, sizeof stream[0]);
        for (unsigned i = 0; i < length; i++)
            primitives[first + i] = stream[i].hit.primID;
    }
}
#endif

/* Defines first_hits_WIDTH: packets of WIDTH rays; the lanes past the last ray are inactive. */
#define DEFINE_FIRST_HITS(WIDTH)                                                                                       \
    static void first_hits_##WIDTH(const Eye *eye, const float *directions, size_t count, uint32_t *primitives)        \
    {                                                                                                                  \
        EmbreeContext context;                                                                                         \
        FirstHitArguments arguments = first_hit_arguments(&context, eye->flags);                                       \
        struct RTCRayHit##WIDTH packet;                                                                                \
        alignas(4 * WIDTH) int valid[WIDTH];                                                                           \
        memset(&packet, 0, sizeof packet);                                                                             \
        for (unsigned lane = 0; lane < WIDTH; lane++) {                                                                \
            packet.ray.org_x[lane] = eye->origin[0];                                                                   \
            packet.ray.org_y[lane] = eye->origin[1];                                                                   \
            packet.ray.org_z[lane] = eye->origin[2];                                                                   \
            packet.ray.mask[lane] = 0xFFFFFFFFu;                                                                       \
            packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;                                                      \
            valid[lane] = -1;                                                                                          \
        }                                                                                                              \
        for (size_t first = 0; first < count; first += WIDTH) {                                                        \
            const unsigned active = count - first < WIDTH ? (unsigned)(count - first) : WIDTH;                         \
            for (unsigned lane = 0; lane < active; lane++) {                                                           \
                const float *direction = &directions[3 * (first + lane)];                                              \
                packet.ray.dir_x[lane] = direction[0];                                                                 \
                packet.ray.dir_y[lane] = direction[1];                                                                 \
                packet.ray.dir_z[lane] = direction[2];                                                                 \
            }                                                                                                          \
            for (unsigned lane = 0; lane < WIDTH; lane++) {                                                            \
                packet.ray.tfar[lane] = INFINITY;                                                                      \
                packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;                                                     \
                packet.hit.primID[lane] = RTC_INVALID_GEOMETRY_ID;                                                     \
            }                                                                                                          \
            for (unsigned lane = active; lane < WIDTH; lane++)                                                         \
                valid[lane] = 0;                                                                                       \
            INTERSECT_N(WIDTH, valid, eye->scene->handle, &packet, &arguments);                                        \
            memcpy(&primitives[first], packet.hit.primID, active * sizeof(uint32_t));                                  \
        }                                                                                                              \
    }

DEFINE_FIRST_HITS(4)
DEFINE_FIRST_HITS(8)
DEFINE_FIRST_HITS(16)

uint32_t lb_scene_first_hits(const LbScene *scene, const float *origin, const float *directions, size_t count,
                             uint32_t grouping, uint32_t flags, uint32_t *primitives, LbError *error)
{
    _Static_assert(LB_NO_PRIMITIVE == RTC_INVALID_GEOMETRY_ID, "what Embree says of a ray that hits nothing");
    Call call = lb_begin_call(error);
    const Eye eye = { scene, origin, flags };
    lb_choose_denormals(flags & LB_QUERY_FLUSH_DENORMALS);
    switch (grouping) {
    case LB_PACKET_1: first_hits_1(&eye, directions, count, primitives); break;
    case LB_PACKET_4: first_hits_4(&eye, directions, count, primitives); break;
    case LB_PACKET_8: first_hits_8(&eye, directions, count, primitives); break;
    case LB_PACKET_16: first_hits_16(&eye, directions, count, primitives); break;
    case LB_STREAM:
#if LB_EMBREE_MAJOR == 3
        if (lb_has_streams(scene->device)) {
            first_hits_stream(&eye, directions, count, primitives);
            break;
        }
#endif
        lb_fail(call, "this Embree has no ray streams");
        break;
    default: lb_fail(call, "packets have 1, 4, 8 or 16 rays");
    }
    return lb_end_call(call, scene->device);
}
