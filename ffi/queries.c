/* The queries of shim.h and the filter, for Embree 3 and Embree 4. See README.md. */

#include "internal.h"

#include <float.h>
#include <math.h>
#include <stdalign.h>
#include <string.h>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

/* ---- The filter ---- */

/* The texel of a row of `size` that shows at a texture coordinate. */
static uint32_t texel(float coordinate, uint32_t size, uint32_t wrap)
{
    const float place = floorf(coordinate * (float)size);
    if (wrap == LB_WRAP_CLAMP)
        return place <= 0.0f ? 0 : place >= (float)size ? size - 1 : (uint32_t)place;
    /* Exact, and below the period in magnitude; what is not a number counts as 0. */
    const float period = wrap == LB_WRAP_MIRRORED ? 2.0f * (float)size : (float)size;
    const float rest = fmodf(place, period);
    const float there = rest < 0.0f ? rest + period : rest;
    const uint32_t at = there >= 0.0f && there < period ? (uint32_t)there : 0;
    return at < size ? at : 2 * size - 1 - at;
}

/* Whether a hit, at Embree's barycentric coordinates, is a hole. */
static bool is_hole(const LbHoles *holes, uint32_t triangle, float u, float v)
{
    const uint32_t index = holes->mask_of[triangle];
    if (index == LB_NO_MASK)
        return false;
    const LbMask *mask = &holes->masks[index];
    const float *corner = &holes->coordinates[6 * (size_t)triangle];
    const float w = 1.0f - u - v;
    const uint32_t column = texel(w * corner[0] + u * corner[2] + v * corner[4], mask->size[0], mask->wrap[0]);
    const uint32_t row = texel(w * corner[1] + u * corner[3] + v * corner[5], mask->size[1], mask->wrap[1]);
    const size_t bit = (size_t)row * mask->size[0] + column;
    return !(mask->there[bit / 64] >> (bit % 64) & 1);
}

void lb_collect(const QueryContext *context, uint32_t ray_id, size_t primitive, unsigned times)
{
    Collector *collector = context->collector;
    if (!collector)
        return;
    if (collector->found < collector->capacity) {
        const size_t ray = (size_t)(context->rays - collector->first_ray) + ray_id;
        collector->crossings[collector->found] = (LbCrossing){ (uint32_t)ray, (uint32_t)primitive, times };
    }
    collector->found++;
}

/* Embree may call with any N up to the packet's width, lanes in any order, so a ray is known by its id alone. */
void lb_reject_hits(const struct RTCFilterFunctionNArguments *arguments)
{
    enum { HIT_U_FIELD = 3, HIT_V_FIELD = 4, HIT_PRIMITIVE_FIELD = 5 };
    const QueryContext *context = (const QueryContext *)arguments->context;
    const LbScene *scene = arguments->geometryUserPtr;
    const unsigned int lanes = arguments->N;
    const unsigned int *ray_id = (const unsigned int *)arguments->ray + RAY_ID_FIELD * lanes;
    const float *hit = (const float *)arguments->hit;
    const unsigned int *primitive = (const unsigned int *)arguments->hit + HIT_PRIMITIVE_FIELD * lanes;
    for (unsigned int lane = 0; lane < lanes; lane++) {
        /* Only -1 is a lane with a hit; the id of any other lane means nothing. */
        if (arguments->valid[lane] != -1)
            continue;
        const float u = hit[HIT_U_FIELD * lanes + lane], v = hit[HIT_V_FIELD * lanes + lane];
        const bool is_excluded = scene->filtered && context->rays[ray_id[lane]].excluded == primitive[lane];
        if (is_excluded || (scene->has_holes && is_hole(&scene->holes, primitive[lane], u, v))) {
            arguments->valid[lane] = 0;
        } else if (scene->parts.transparent && scene->parts.transparent[primitive[lane]]) {
            lb_collect(context, ray_id[lane], primitive[lane], 1);
            arguments->valid[lane] = 0;
        }
    }
}

/* ---- Queries ---- */

/* The arguments of a query beside the rays, in the shape that this version of Embree wants them. */
#if LB_EMBREE_MAJOR == 4
typedef struct RTCOccludedArguments QueryArguments;

static QueryArguments query_arguments(QueryContext *context, const LbScene *scene, uint32_t flags)
{
    QueryArguments arguments;
    const unsigned curved = scene->parts.curved_count ? RTC_FEATURE_FLAG_USER_GEOMETRY_CALLBACK_IN_GEOMETRY : 0;
    rtcInitRayQueryContext(&context->embree);
    rtcInitOccludedArguments(&arguments);
    arguments.flags = flags & LB_QUERY_COHERENT ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    arguments.feature_mask =
        (enum RTCFeatureFlags)(RTC_FEATURE_FLAG_TRIANGLE | RTC_FEATURE_FLAG_FILTER_FUNCTION_IN_GEOMETRY | curved);
    arguments.context = &context->embree;
    return arguments;
}

#define OCCLUDED_1(scene, ray, arguments) rtcOccluded1(scene, ray, arguments)
#define OCCLUDED_N(width, valid, scene, packet, arguments) rtcOccluded##width(valid, scene, packet, arguments)
#else
typedef EmbreeContext *QueryArguments;

static QueryArguments query_arguments(QueryContext *context, const LbScene *scene, uint32_t flags)
{
    (void)scene;
    rtcInitIntersectContext(&context->embree);
    context->embree.flags =
        flags & LB_QUERY_COHERENT ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return &context->embree;
}

#define OCCLUDED_1(scene, ray, arguments) rtcOccluded1(scene, *(arguments), ray)
#define OCCLUDED_N(width, valid, scene, packet, arguments) rtcOccluded##width(valid, scene, *(arguments), packet)
#endif

/* Embree marks an occluded ray by t_far = -infinity and leaves that of any other as it was. */
static uint8_t answer(float t_far) { return t_far < -FLT_MAX; }

/* `id` is what the filter knows the ray by. */
static inline struct RTCRay embree_ray(const LbRay *from, unsigned id)
{
    struct RTCRay ray;
    ray.org_x = from->origin[0];
    ray.org_y = from->origin[1];
    ray.org_z = from->origin[2];
    ray.tnear = from->t_near;
    ray.dir_x = from->direction[0];
    ray.dir_y = from->direction[1];
    ray.dir_z = from->direction[2];
    ray.time = 0.0f;
    ray.tfar = from->t_far;
    ray.mask = 0xFFFFFFFFu;
    ray.id = id;
    ray.flags = 0;
    return ray;
}

static void occluded_1(const LbScene *scene, const LbRay *rays, size_t count, uint32_t flags, Collector *collector,
                       uint8_t *answers)
{
    QueryContext context;
    QueryArguments arguments = query_arguments(&context, scene, flags);
    context.collector = collector;
    for (size_t i = 0; i < count; i++) {
        struct RTCRay ray = embree_ray(&rays[i], 0);
        context.rays = &rays[i];
        OCCLUDED_1(scene->handle, &ray, &arguments);
        answers[i] = answer(ray.tfar);
    }
}

#if LB_EMBREE_MAJOR == 3
/*
 * Streams of LB_STREAM rays, the last one shorter: so many fit on the stack and in the first cache, and Embree itself
 * takes a stream apart into pieces that are shorter still.
 */
static void occluded_stream(const LbScene *scene, const LbRay *rays, size_t count, uint32_t flags,
                            Collector *collector, uint8_t *answers)
{
    QueryContext context;
    QueryArguments arguments = query_arguments(&context, scene, flags);
    struct RTCRay stream[LB_STREAM];
    context.collector = collector;
    for (size_t first = 0; first < count; first += LB_STREAM) {
        const unsigned length = count - first < LB_STREAM ? (unsigned)(count - first) : LB_STREAM;
        for (unsigned i = 0; i < length; i++)
            stream[i] = embree_ray(&rays[first + i], i);
        context.rays = &rays[first];
        rtcOccluded1M(scene->handle, arguments, stream, length, sizeof stream[0]);
        for (unsigned i = 0; i < length; i++)
            answers[first + i] = answer(stream[i].tfar);
    }
}
#endif

/* Where the fields of a packet's lanes lie: RTCRay4, 8 and 16 differ in the length of these arrays alone. */
typedef struct Lanes {
    float *org_x, *org_y, *org_z, *tnear, *dir_x, *dir_y, *dir_z, *tfar;
} Lanes;

static inline void load_lanes(Lanes to, const LbRay *rays, unsigned count)
{
    unsigned lane = 0;
#if defined(__x86_64__)
    /* Four rays at a time, because this is a good part of what a short query takes. */
    _Static_assert(offsetof(LbRay, t_near) == 12 && offsetof(LbRay, direction) == 16 && offsetof(LbRay, t_far) == 28
                       && sizeof(LbRay) % sizeof(float) == 0,
                   "a ray begins with its start and its way, four floats each");
    for (; lane + 4 <= count; lane += 4) {
        const float *ray = (const float *)&rays[lane];
        const size_t next = sizeof(LbRay) / sizeof(float);
        __m128 start_0 = _mm_loadu_ps(ray), way_0 = _mm_loadu_ps(ray + 4);
        __m128 start_1 = _mm_loadu_ps(ray + next), way_1 = _mm_loadu_ps(ray + next + 4);
        __m128 start_2 = _mm_loadu_ps(ray + 2 * next), way_2 = _mm_loadu_ps(ray + 2 * next + 4);
        __m128 start_3 = _mm_loadu_ps(ray + 3 * next), way_3 = _mm_loadu_ps(ray + 3 * next + 4);
        _MM_TRANSPOSE4_PS(start_0, start_1, start_2, start_3);
        _MM_TRANSPOSE4_PS(way_0, way_1, way_2, way_3);
        _mm_storeu_ps(to.org_x + lane, start_0);
        _mm_storeu_ps(to.org_y + lane, start_1);
        _mm_storeu_ps(to.org_z + lane, start_2);
        _mm_storeu_ps(to.tnear + lane, start_3);
        _mm_storeu_ps(to.dir_x + lane, way_0);
        _mm_storeu_ps(to.dir_y + lane, way_1);
        _mm_storeu_ps(to.dir_z + lane, way_2);
        _mm_storeu_ps(to.tfar + lane, way_3);
    }
#endif
    for (; lane < count; lane++) {
        to.org_x[lane] = rays[lane].origin[0];
        to.org_y[lane] = rays[lane].origin[1];
        to.org_z[lane] = rays[lane].origin[2];
        to.tnear[lane] = rays[lane].t_near;
        to.dir_x[lane] = rays[lane].direction[0];
        to.dir_y[lane] = rays[lane].direction[1];
        to.dir_z[lane] = rays[lane].direction[2];
        to.tfar[lane] = rays[lane].t_far;
    }
}

/*
 * Defines occluded_WIDTH: packets of WIDTH rays, whose alignment is WIDTH floats; the lanes past the last ray are
 * inactive.
 */
#define DEFINE_OCCLUDED(WIDTH)                                                                                         \
    static void occluded_##WIDTH(const LbScene *scene, const LbRay *rays, size_t count, uint32_t flags,                \
                                 Collector *collector, uint8_t *answers)                                               \
    {                                                                                                                  \
        QueryContext context;                                                                                          \
        QueryArguments arguments = query_arguments(&context, scene, flags);                                            \
        struct RTCRay##WIDTH packet;                                                                                   \
        alignas(4 * WIDTH) int valid[WIDTH];                                                                           \
        const Lanes lanes = { packet.org_x, packet.org_y, packet.org_z, packet.tnear,                                  \
                              packet.dir_x, packet.dir_y, packet.dir_z, packet.tfar };                                 \
        memset(&packet, 0, sizeof packet);                                                                             \
        context.collector = collector;                                                                                 \
        for (unsigned lane = 0; lane < WIDTH; lane++) {                                                                \
            packet.mask[lane] = 0xFFFFFFFFu;                                                                           \
            packet.id[lane] = lane;                                                                                    \
            valid[lane] = -1;                                                                                          \
        }                                                                                                              \
        for (size_t first = 0; first < count; first += WIDTH) {                                                        \
            const unsigned active = count - first < WIDTH ? (unsigned)(count - first) : WIDTH;                         \
            load_lanes(lanes, &rays[first], active);                                                                   \
            context.rays = &rays[first];                                                                               \
            for (unsigned lane = active; lane < WIDTH; lane++)                                                         \
                valid[lane] = 0;                                                                                       \
            OCCLUDED_N(WIDTH, valid, scene->handle, &packet, &arguments);                                              \
            for (unsigned lane = 0; lane < active; lane++)                                                             \
                answers[first + lane] = answer(packet.tfar[lane]);                                                     \
        }                                                                                                              \
    }

DEFINE_OCCLUDED(4)
DEFINE_OCCLUDED(8)
DEFINE_OCCLUDED(16)

/* `collector` may be null. */
static void ask(Call call, const LbScene *scene, const LbRay *rays, size_t count, uint32_t grouping, uint32_t flags,
                Collector *collector, uint8_t *answers)
{
    lb_choose_denormals(flags & LB_QUERY_FLUSH_DENORMALS);
    switch (grouping) {
    case LB_PACKET_1: occluded_1(scene, rays, count, flags, collector, answers); break;
    case LB_PACKET_4: occluded_4(scene, rays, count, flags, collector, answers); break;
    case LB_PACKET_8: occluded_8(scene, rays, count, flags, collector, answers); break;
    case LB_PACKET_16: occluded_16(scene, rays, count, flags, collector, answers); break;
    case LB_STREAM:
#if LB_EMBREE_MAJOR == 3
        if (lb_has_streams(scene->device)) {
            occluded_stream(scene, rays, count, flags, collector, answers);
            break;
        }
#endif
        lb_fail(call, "this Embree has no ray streams");
        break;
    default: lb_fail(call, "packets have 1, 4, 8 or 16 rays");
    }
}

uint32_t lb_scene_occluded(const LbScene *scene, const LbRay *rays, size_t count, uint32_t grouping, uint32_t flags,
                           uint8_t *answers, LbError *error)
{
    Call call = lb_begin_call(error);
    ask(call, scene, rays, count, grouping, flags, NULL, answers);
    return lb_end_call(call, scene->device);
}

uint32_t lb_scene_crossed(const LbScene *scene, const LbRay *rays, size_t count, uint32_t grouping, uint32_t flags,
                          uint8_t *answers, LbCrossing *crossings, size_t capacity, size_t *found, LbError *error)
{
    Call call = lb_begin_call(error);
    Collector collector = { rays, crossings, capacity, 0 };
    ask(call, scene, rays, count, grouping, flags, &collector, answers);
    *found = collector.found;
    return lb_end_call(call, scene->device);
}
