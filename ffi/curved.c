/* Curved surfaces: a user geometry of Embree, met by its float rays in double precision. See README.md. */

#include "internal.h"

#include <math.h>

typedef struct Vector {
    double x, y, z;
} Vector;

/* The points start + t * way. */
typedef struct Line {
    Vector start, way;
} Line;

/* The polynomial a t^2 + 2 b t + c whose zeros are where a line meets a surface without regard to its bounds. */
typedef struct Quadratic {
    double a, b, c;
} Quadratic;

/* Where they are: `count` of them. */
typedef struct Roots {
    double t[2];
    unsigned count;
} Roots;

static Vector vector(const double *from) { return (Vector){ from[0], from[1], from[2] }; }
static double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static Vector minus(Vector a, Vector b) { return (Vector){ a.x - b.x, a.y - b.y, a.z - b.z }; }
/* a + t * b */
static Vector along(Vector a, double t, Vector b) { return (Vector){ a.x + t * b.x, a.y + t * b.y, a.z + t * b.z }; }
static Vector at(Line line, double t) { return along(line.start, t, line.way); }

static bool is_flat(const LbCurved *curved) { return curved->kind == LB_DISC || curved->kind == LB_PLANE; }

/* ---- Each kind of surface ---- */

static Quadratic meet_sphere(const LbCurved *curved, Line line)
{
    const double radius = curved->surface.sphere.radius;
    const Vector start = minus(line.start, vector(curved->anchor));
    return (Quadratic){ dot(line.way, line.way), dot(start, line.way), dot(start, start) - radius * radius };
}

static Vector to_unit(const LbEllipsoid *ellipsoid, Vector v)
{
    return (Vector){ dot(vector(ellipsoid->to_unit[0]), v), dot(vector(ellipsoid->to_unit[1]), v),
                     dot(vector(ellipsoid->to_unit[2]), v) };
}

static Quadratic meet_ellipsoid(const LbCurved *curved, Line line)
{
    const LbEllipsoid *ellipsoid = &curved->surface.ellipsoid;
    const Vector start = to_unit(ellipsoid, minus(line.start, vector(curved->anchor)));
    const Vector way = to_unit(ellipsoid, line.way);
    return (Quadratic){ dot(way, way), dot(start, way), dot(start, start) - 1.0 };
}

/* How far along the axis the foot of a vector lies: 1 is its end. */
static double height(const LbCone *cone, Vector v)
{
    const Vector axis = vector(cone->axis);
    return dot(v, axis) / dot(axis, axis);
}

/* The squared distance from the axis less the squared radius at that height. */
static Quadratic meet_cone(const LbCurved *curved, Line line)
{
    const LbCone *cone = &curved->surface.cone;
    const Vector axis = vector(cone->axis), start = minus(line.start, vector(curved->anchor));
    const double start_height = height(cone, start), way_height = height(cone, line.way);
    const Vector start_off = along(start, -start_height, axis), way_off = along(line.way, -way_height, axis);
    const double radius = cone->base_radius + cone->growth * start_height, growth = cone->growth * way_height;
    return (Quadratic){ dot(way_off, way_off) - growth * growth, dot(start_off, way_off) - radius * growth,
                        dot(start_off, start_off) - radius * radius };
}

/* v . S w for the symmetric S of a quadric's second-degree coefficients. */
static double form(const double *second, Vector v, Vector w)
{
    return second[0] * v.x * w.x + second[1] * v.y * w.y + second[2] * v.z * w.z
           + 0.5 * (second[3] * (v.x * w.y + v.y * w.x) + second[4] * (v.y * w.z + v.z * w.y)
                    + second[5] * (v.z * w.x + v.x * w.z));
}

static Quadratic meet_quadric(const LbCurved *curved, Line line)
{
    const LbQuadric *quadric = &curved->surface.quadric;
    const Vector start = minus(line.start, vector(curved->anchor)), first = vector(quadric->first);
    return (Quadratic){ form(quadric->second, line.way, line.way),
                        form(quadric->second, start, line.way) + 0.5 * dot(first, line.way),
                        form(quadric->second, start, start) + dot(first, start) + quadric->constant };
}

static Quadratic meet(const LbCurved *curved, Line line)
{
    switch (curved->kind) {
    case LB_SPHERE: return meet_sphere(curved, line);
    case LB_ELLIPSOID: return meet_ellipsoid(curved, line);
    case LB_CONE: return meet_cone(curved, line);
    default: return meet_quadric(curved, line);
    }
}

/* A point in the middle of a surface that is not flat. */
static Vector middle(const LbCurved *curved)
{
    const float *low = curved->low, *high = curved->high;
    switch (curved->kind) {
    case LB_CONE: return along(vector(curved->anchor), 0.5, vector(curved->surface.cone.axis));
    case LB_QUADRIC:
        return (Vector){ 0.5 * ((double)low[0] + (double)high[0]), 0.5 * ((double)low[1] + (double)high[1]),
                         0.5 * ((double)low[2] + (double)high[2]) };
    default: return vector(curved->anchor);
    }
}

/*
 * Whether a point of the unbounded surface belongs to the surface; its bounds do. A cone goes on behind its tip, but
 * never between its ends, where no radius is negative.
 */
static bool is_within(const LbCurved *curved, Vector point)
{
    switch (curved->kind) {
    case LB_CONE: {
        const double there = height(&curved->surface.cone, minus(point, vector(curved->anchor)));
        return there >= 0.0 && there <= 1.0;
    }
    case LB_DISC: {
        const Vector off = minus(point, vector(curved->anchor));
        const double radius = curved->surface.disc.radius;
        return dot(off, off) <= radius * radius;
    }
    case LB_QUADRIC: {
        const float *low = curved->low, *high = curved->high;
        return point.x >= low[0] && point.y >= low[1] && point.z >= low[2] && point.x <= high[0] && point.y <= high[1]
               && point.z <= high[2];
    }
    default: return true;
    }
}

/* ---- Where a line meets it ---- */

/* A root that is no number or infinite is none: the line meets the surface less often, or lies in it. */
static void add_root(Roots *roots, double t)
{
    if (isfinite(t))
        roots->t[roots->count++] = t;
}

/* Without the difference of nearly equal numbers that the textbook's formula has for one of the roots. */
static Roots solve(Quadratic q)
{
    Roots roots = { { 0.0, 0.0 }, 0 };
    const double discriminant = q.b * q.b - q.a * q.c;
    if (!(discriminant >= 0.0))
        return roots;
    const double sum = -(q.b + copysign(sqrt(discriminant), q.b));
    add_root(&roots, sum / q.a);
    /* Both are zero where this is, unless the line lies in the surface. */
    add_root(&roots, sum == 0.0 ? sum / q.a : q.c / sum);
    return roots;
}

static Roots meet_flat(const LbCurved *curved, Line line)
{
    const Vector normal =
        vector(curved->kind == LB_DISC ? curved->surface.disc.normal : curved->surface.plane.normal);
    Roots roots = { { 0.0, 0.0 }, 0 };
    add_root(&roots, dot(minus(vector(curved->anchor), line.start), normal) / dot(line.way, normal));
    return roots;
}

/*
 * Far away from a small surface the polynomial's coefficients are large and its discriminant is their small difference.
 * So the line is made to start at its point next to the middle of the surface.
 */
static Roots meet_curved(const LbCurved *curved, Line line)
{
    const double shift = dot(minus(middle(curved), line.start), line.way) / dot(line.way, line.way);
    Roots roots = solve(meet(curved, (Line){ at(line, shift), line.way }));
    for (unsigned i = 0; i < roots.count; i++)
        roots.t[i] += shift;
    return roots;
}

/*
 * The line starts on the surface, though rounding has moved its start off it: the constant term, which says how far
 * off, is zero, and so is one root. What remains is the other one. To leave out the root next to zero instead would do
 * as well but where the line is almost tangential: there rounding may have left it no root at all.
 */
static Roots meet_again(const LbCurved *curved, Line line)
{
    Roots roots = { { 0.0, 0.0 }, 0 };
    if (!is_flat(curved)) {
        const Quadratic q = meet(curved, line);
        add_root(&roots, -2.0 * q.b / q.a);
    }
    return roots;
}

/* ---- Callbacks ---- */

/* At how many points of t_near <= t <= t_far a line meets a surface. */
static unsigned times_met(const LbCurved *curved, Line line, double t_near, double t_far, bool starts_on_it)
{
    const Roots roots = starts_on_it       ? meet_again(curved, line)
                        : is_flat(curved) ? meet_flat(curved, line)
                                          : meet_curved(curved, line);
    unsigned times = 0;
    for (unsigned i = 0; i < roots.count; i++)
        times += roots.t[i] >= t_near && roots.t[i] <= t_far && is_within(curved, at(line, roots.t[i]));
    return times;
}

static void set_bounds(const struct RTCBoundsFunctionArguments *arguments)
{
    const LbScene *scene = arguments->geometryUserPtr;
    const LbCurved *curved = &scene->parts.curved[arguments->primID];
    struct RTCBounds *bounds = arguments->bounds_o;
    bounds->lower_x = curved->low[0];
    bounds->lower_y = curved->low[1];
    bounds->lower_z = curved->low[2];
    bounds->upper_x = curved->high[0];
    bounds->upper_y = curved->high[1];
    bounds->upper_z = curved->high[2];
}

/* Embree calls with 1 to 16 lanes, and with lanes in any order: as in the filter, a ray is known by its id. */
static void occlude(const struct RTCOccludedFunctionNArguments *arguments)
{
    const QueryContext *context = (const QueryContext *)arguments->context;
    const LbScene *scene = arguments->geometryUserPtr;
    const LbCurved *curved = &scene->parts.curved[arguments->primID];
    const size_t primitive = scene->parts.triangle_count + arguments->primID;
    const unsigned int lanes = arguments->N;
    float *rays = (float *)arguments->ray;
    const unsigned int *ray_id = (const unsigned int *)arguments->ray + RAY_ID_FIELD * lanes;
    for (unsigned int lane = 0; lane < lanes; lane++) {
        if (arguments->valid[lane] != -1)
            continue;
        const float *ray = rays + lane;
        const float *start = ray + ORIGIN_FIELD * lanes, *way = ray + DIRECTION_FIELD * lanes;
        const Line line = { { start[0], start[lanes], start[2 * lanes] }, { way[0], way[lanes], way[2 * lanes] } };
        const bool starts_on_it = scene->filtered && context->rays[ray_id[lane]].excluded == primitive;
        const unsigned times =
            times_met(curved, line, ray[T_NEAR_FIELD * lanes], ray[T_FAR_FIELD * lanes], starts_on_it);
        if (!times)
            continue;
        if (curved->transparent)
            lb_collect(context, ray_id[lane], primitive, times);
        else
            rays[T_FAR_FIELD * lanes + lane] = -INFINITY;
    }
}

RTCGeometry lb_new_curved(Call call, LbScene *scene)
{
    if (!lb_property(scene->device, RTC_DEVICE_PROPERTY_USER_GEOMETRY_SUPPORTED)) {
        lb_fail(call, "this Embree was built without user geometries, so it has no curved surfaces");
        return NULL;
    }
    RTCGeometry geometry = rtcNewGeometry(scene->device->handle, RTC_GEOMETRY_TYPE_USER);
    if (!geometry) {
        lb_fail(call, "no geometry");
        return NULL;
    }
    rtcSetGeometryUserPrimitiveCount(geometry, (unsigned int)scene->parts.curved_count);
    rtcSetGeometryUserData(geometry, scene);
    rtcSetGeometryBoundsFunction(geometry, set_bounds, NULL);
    rtcSetGeometryOccludedFunction(geometry, occlude);
    return geometry;
}
