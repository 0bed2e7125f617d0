/*
 * lightbuffer.h: exact shadow testing from C and C++.
 *
 * A scene is triangles. A tester is built for a scene and one light, and answers, for many points at once, whether
 * anything blocks the open segment from the point to the light. The native testers answer exactly: no epsilon, no
 * offset; what they say does not depend on resolution, threads, instruction set or the order of the triangles.
 *
 * Numbers. Coordinates are float, because floats are what the library keeps: they are taken as they are, bit by bit,
 * in world space, and nothing is rounded on the way in. Any unit of length will do. A point on a surface is given by
 * the ray that finds it: the exact intersection of ray and triangle is what is asked, which no float or double could
 * hold. A float point near a surface is in front of it or behind it, and shadowed by it or not accordingly.
 *
 * Errors. Functions that can fail return LIGHTBUFFER_OK or one of the LIGHTBUFFER_ERROR_ codes; then
 * lightbuffer_error_text() says why, in one line, and nothing has been written to the caller's arrays or handles.
 *
 * Threads. Every function may be called by any thread. A scene or a tester may be used by many threads at once, with
 * the two exceptions that nobody uses it while or after it is freed. Arrays belong to the caller, must not be written to by
 * others during a call, are not kept after it, and must not overlap where one is an output. The library starts threads of
 * its own; a child of fork() has none of them and must not ask.
 */
#ifndef LIGHTBUFFER_H
#define LIGHTBUFFER_H

#include <stdint.h>

#ifndef LIGHTBUFFER_API
#if defined(__GNUC__)
#define LIGHTBUFFER_API __attribute__((visibility("default")))
#else
#define LIGHTBUFFER_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this header; lightbuffer_version() is that of the library. */
#define LIGHTBUFFER_VERSION "0.1.0"
#define LIGHTBUFFER_VERSION_MAJOR 0
#define LIGHTBUFFER_VERSION_MINOR 1
#define LIGHTBUFFER_VERSION_PATCH 0

/* What functions return. */
#define LIGHTBUFFER_OK 0
/* An argument is wrong: a null pointer, a number that is not finite or out of range, an index, a name. */
#define LIGHTBUFFER_ERROR_ARGUMENT 1
/* The arguments are right, and the tester has no answer for them, or would need more memory than there is. */
#define LIGHTBUFFER_ERROR_REFUSED 2
/* A mistake in the library. What was asked has no answer; handles can still be freed. */
#define LIGHTBUFFER_ERROR_INTERNAL 3

/* Kinds of light. */
#define LIGHTBUFFER_LIGHT_POINT 0
#define LIGHTBUFFER_LIGHT_DIRECTIONAL 1

/* Where points may be that a tester is asked about: lightbuffer_settings.receivers. */
#define LIGHTBUFFER_ANYWHERE 0
#define LIGHTBUFFER_SURFACES 1

/* lightbuffer_settings.resolution and .threads, if the library is to choose. */
#define LIGHTBUFFER_RESOLUTION_AUTO 0
#define LIGHTBUFFER_ALL_THREADS 0

/* In place of a triangle: there is none. */
#define LIGHTBUFFER_NO_TRIANGLE UINT32_C(0xFFFFFFFF)

/* Answers. */
/* Nothing blocks the segment. */
#define LIGHTBUFFER_LIT 0
/* Something does. */
#define LIGHTBUFFER_OCCLUDED 1
/* Dark without a question: the start of the ray and the light are not strictly on the same side of the surface. */
#define LIGHTBUFFER_FACES_AWAY 2
/* The ray hits nothing, so there is no point. */
#define LIGHTBUFFER_NO_SURFACE 3

/* Triangles, and what is made of them once for all lights. */
typedef struct lightbuffer_scene lightbuffer_scene;

/* A shadow tester, built for a scene and a light. */
typedef struct lightbuffer_tester lightbuffer_tester;

/* Triangles that belong together: an object. Which object a triangle belongs to makes no difference to an exact answer. */
typedef struct lightbuffer_mesh {
    /* x, y, z of each vertex. */
    const float *vertices;
    /* How many vertices: a third of the floats. */
    uint64_t vertex_count;
    /* Three indices into the vertices of this mesh for each triangle; which way round makes no difference. */
    const uint32_t *triangles;
    /* How many triangles: a third of the indices. */
    uint64_t triangle_count;
} lightbuffer_mesh;

/* A light. */
typedef struct lightbuffer_light {
    /* LIGHTBUFFER_LIGHT_POINT or LIGHTBUFFER_LIGHT_DIRECTIONAL. */
    uint32_t kind;
    /* Where the point is; or the direction from surfaces towards the light, not zero, of any length. */
    float vector[3];
} lightbuffer_light;

/* How a tester is built. All zero is as usual. */
typedef struct lightbuffer_settings {
    /* "auto", "light-buffer", "irregular-z-buffer", "bounding-volumes", "brute-force", "exact", "shadow-buffer", and, where
       the library was built with Embree, "embree" and its modes; NULL is "auto". An unknown name is an error whose text lists
       them. Answers of "shadow-buffer" and of Embree are not exact. */
    const char *tester;
    /* The most memory that the tester may need, in bytes, as far as that is known before; 0 is what the machine has free. */
    uint64_t memory_limit;
    /* Cells along a cube face, from 1 to 4096, for testers with cells; or LIGHTBUFFER_RESOLUTION_AUTO. */
    uint32_t resolution;
    /* Threads that build and answer, from 1 to 1024, or LIGHTBUFFER_ALL_THREADS: one for each processor. Testers with the
       same number share them, and so do threads that ask at the same time. */
    uint32_t threads;
    /* LIGHTBUFFER_ANYWHERE, or LIGHTBUFFER_SURFACES if lightbuffer_occluded_at is never called: some testers then have less
       to keep. */
    uint32_t receivers;
    /* For later; must be 0. */
    uint32_t reserved;
} lightbuffer_settings;

/* A ray: from its origin, exclusively, on in one direction without end. */
typedef struct lightbuffer_ray {
    float origin[3];
    /* Not zero, of any length. */
    float direction[3];
} lightbuffer_ray;

/*
 * The version of the library, such as "0.1.0".
 * Thread-safe. The text lives as long as the library.
 */
LIGHTBUFFER_API const char *lightbuffer_version(void);

/*
 * Why the last call by this thread that returned a code failed, in one line of UTF-8; empty if it did not fail. Never NULL.
 * Thread-safe: each thread has its own text, which lives until it makes the next call of this library.
 */
LIGHTBUFFER_API const char *lightbuffer_error_text(void);

/*
 * Makes a scene of mesh_count meshes and sets *scene. Triangles are numbered through: those of the first mesh from 0, then those
 * of the second. Triangles of zero area are left out and keep their numbers. All is copied.
 * Thread-safe.
 *
 * LIGHTBUFFER_ERROR_ARGUMENT: a coordinate is not finite, an index is out of range, or there are more than 2^28 vertices or
 * triangles. A scene without triangles is none.
 */
LIGHTBUFFER_API int32_t lightbuffer_scene_new(const lightbuffer_mesh *meshes, uint64_t mesh_count, lightbuffer_scene **scene);

/*
 * How many triangles of a scene were left out because they have no area, which is decided exactly; 0 for NULL.
 * Thread-safe.
 */
LIGHTBUFFER_API uint64_t lightbuffer_scene_dropped_triangles(const lightbuffer_scene *scene);

/*
 * Frees a scene; NULL is none. Testers that were built for it keep what they need, in whatever order they are freed.
 * Thread-safe, but no other thread may use this handle during the call, and nobody after it.
 */
LIGHTBUFFER_API void lightbuffer_scene_free(lightbuffer_scene *scene);

/*
 * Finds for each of count rays the triangle that it hits first, or LIGHTBUFFER_NO_TRIANGLE, exactly; of triangles at the very
 * same distance always the same one, in whatever order they were given. A ray that runs within a triangle's plane misses it.
 * threads is as in lightbuffer_settings. The first call for a scene takes longer.
 * Thread-safe.
 *
 * LIGHTBUFFER_ERROR_ARGUMENT: a ray is not finite or has no direction.
 */
LIGHTBUFFER_API int32_t lightbuffer_first_hits(const lightbuffer_scene *scene, uint32_t threads, const lightbuffer_ray *rays,
                                               uint64_t count, uint32_t *triangles);

/*
 * Builds a tester for a scene and a light and sets *tester. settings may be NULL, which is all zero.
 * Thread-safe.
 *
 * LIGHTBUFFER_ERROR_ARGUMENT: an unknown name, a light that is not finite, or a setting out of range.
 * LIGHTBUFFER_ERROR_REFUSED: the tester has no answer for this kind of light, needs too much memory, or its library or the
 * system refuses.
 */
LIGHTBUFFER_API int32_t lightbuffer_tester_new(const lightbuffer_scene *scene, const lightbuffer_light *light,
                                               const lightbuffer_settings *settings, lightbuffer_tester **tester);

/*
 * Asks about count points on surfaces: point i is the exact intersection of rays[i] with triangles[i], which it must hit, and
 * answers[i] becomes LIGHTBUFFER_LIT, _OCCLUDED, _FACES_AWAY or _NO_SURFACE; the last where triangles[i] is
 * LIGHTBUFFER_NO_TRIANGLE. What lightbuffer_first_hits found can be asked of the testers of many lights. If triangles is NULL
 * they are found as it does. Nothing in the plane of a point's own triangle blocks.
 * Many points in one call take less time each than few.
 * Thread-safe.
 *
 * LIGHTBUFFER_ERROR_ARGUMENT: a ray is not finite, has no direction, or does not hit its triangle.
 * LIGHTBUFFER_ERROR_REFUSED: there is too little memory, or the library behind the tester fails.
 */
LIGHTBUFFER_API int32_t lightbuffer_occluded(const lightbuffer_tester *tester, const lightbuffer_ray *rays,
                                             const uint32_t *triangles, uint64_t count, uint8_t *answers);

/*
 * Asks about count points in space, x, y, z each: each point is its own exact position. It lies on no surface, so it faces every light,
 * and any triangle but one that holds the very point blocks: answers[i] becomes LIGHTBUFFER_LIT or LIGHTBUFFER_OCCLUDED.
 * Not for points of surfaces, unless their floats are exactly on them: rounding has moved them off.
 * Thread-safe.
 *
 * LIGHTBUFFER_ERROR_ARGUMENT: a coordinate is not finite.
 * LIGHTBUFFER_ERROR_REFUSED: the tester was built for LIGHTBUFFER_SURFACES; and as lightbuffer_occluded.
 */
LIGHTBUFFER_API int32_t lightbuffer_occluded_at(const lightbuffer_tester *tester, const float *points, uint64_t count,
                                                uint8_t *answers);

/*
 * Memory that a tester keeps beside its scene, in bytes; 0 for NULL. It may grow when the tester is asked.
 * Thread-safe.
 */
LIGHTBUFFER_API uint64_t lightbuffer_tester_bytes(const lightbuffer_tester *tester);

/*
 * Frees a tester; NULL is none.
 * Thread-safe, but no other thread may use this handle during the call, and nobody after it.
 */
LIGHTBUFFER_API void lightbuffer_tester_free(lightbuffer_tester *tester);

#ifdef __cplusplus
}
#endif

#endif
