/*
 * Misuse of the C interface: each mistake gives its code and one line that names it, writes nothing, and loses nothing.
 * Then every exact tester, and one tester asked by eight threads at once.
 */
#include <lightbuffer.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

static void check(int line, int holds, const char *what)
{
    if (!holds) {
        fprintf(stderr, "line %d: %s\n", line, what);
        failures++;
    }
}

#define CHECK(condition) check(__LINE__, (condition), #condition)

/* A call that must fail with a code, and with words in its one line. */
static void refused(int line, int32_t code, int32_t expected, const char *words)
{
    const char *text = lightbuffer_error_text();
    if (code != expected || strstr(text, words) == NULL || strchr(text, '\n') != NULL) {
        fprintf(stderr, "line %d: code %d, \"%s\"; expected %d, \"%s\"\n", line, (int)code, text, (int)expected, words);
        failures++;
    }
}

#define WRONG(call, words) refused(__LINE__, (call), LIGHTBUFFER_ERROR_ARGUMENT, (words))
#define REFUSED(call, words) refused(__LINE__, (call), LIGHTBUFFER_ERROR_REFUSED, (words))
#define FINE(call) refused(__LINE__, (call), LIGHTBUFFER_OK, "")

/* A floor, and above it a square beside a triangle without area. */
static const float vertices[] = {-4, 0, -4, 4, 0, -4, 4, 0, 4, -4, 0, 4, -1, 1, -1, 1, 1, -1, 1, 1, 1, -1, 1, 1};
static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3, 4, 4, 5, 4, 5, 6, 4, 6, 7};
static const lightbuffer_light above = {LIGHTBUFFER_LIGHT_POINT, {0, 3, 0}};
static const lightbuffer_light sun = {LIGHTBUFFER_LIGHT_DIRECTIONAL, {0, 1, 0.25f}};

#define RAYS 6
/* In the shadow, beside it, on the other side of the floor, past everything, on top of the square, at its lower side. */
static const lightbuffer_ray rays[RAYS] = {
    {{0.2f, 0.5f, 0.3f}, {0, -1, 0}}, {{3.7f, 0.5f, 0.3f}, {0, -2, 0}}, {{0.2f, -1, 0.3f}, {0, 1, 0}},
    {{9, 1, 0}, {0, -1, 0}},          {{0.2f, 2, 0.3f}, {0, -1, 0}},    {{0.2f, 0.5f, 0.3f}, {0, 1, 0}}};
static const uint32_t hits[RAYS] = {1, 0, 1, LIGHTBUFFER_NO_TRIANGLE, 4, 4};
static const uint8_t answers_above[RAYS] = {LIGHTBUFFER_OCCLUDED,   LIGHTBUFFER_LIT, LIGHTBUFFER_FACES_AWAY,
                                            LIGHTBUFFER_NO_SURFACE, LIGHTBUFFER_LIT, LIGHTBUFFER_FACES_AWAY};
static const float points[] = {0.5f, 0.5f, 0.5f, 0.5f, 1.5f, 0.5f, 0.5f, 1, 0.5f, 0.25f, -1, 3};
static const uint8_t answers_at[4] = {LIGHTBUFFER_OCCLUDED, LIGHTBUFFER_LIT, LIGHTBUFFER_LIT, LIGHTBUFFER_OCCLUDED};

static lightbuffer_mesh mesh(void)
{
    lightbuffer_mesh mesh;
    mesh.vertices = vertices;
    mesh.vertex_count = 8;
    mesh.triangles = triangles;
    mesh.triangle_count = 5;
    return mesh;
}

static lightbuffer_scene *scene_of(void)
{
    const lightbuffer_mesh all = mesh();
    lightbuffer_scene *scene = NULL;
    FINE(lightbuffer_scene_new(&all, 1, &scene));
    return scene;
}

static void bad_scenes(void)
{
    lightbuffer_scene *const untouched = (lightbuffer_scene *)(void *)&failures;
    lightbuffer_scene *scene = untouched;
    lightbuffer_mesh bad = mesh();
    float broken[24];
    uint32_t outside[15];
    WRONG(lightbuffer_scene_new(NULL, 1, &scene), "meshes is NULL");
    WRONG(lightbuffer_scene_new(NULL, 0, &scene), "a scene needs triangles");
    WRONG(lightbuffer_scene_new(&bad, 1, NULL), "scene is NULL");
    WRONG(lightbuffer_scene_new(&bad, UINT64_MAX, &scene), "no memory holds so many");
    bad.vertices = NULL;
    WRONG(lightbuffer_scene_new(&bad, 1, &scene), "meshes[0].vertices is NULL");
    bad = mesh();
    bad.vertices = (const float *)(const void *)((const char *)vertices + 1);
    WRONG(lightbuffer_scene_new(&bad, 1, &scene), "meshes[0].vertices is not aligned to 4 bytes");
    bad = mesh();
    bad.triangle_count = UINT64_C(1) << 62;
    WRONG(lightbuffer_scene_new(&bad, 1, &scene), "meshes[0].triangles cannot be 4611686018427387904");
    bad = mesh();
    bad.vertex_count = 7;
    WRONG(lightbuffer_scene_new(&bad, 1, &scene), "meshes[0]: triangle 4 has vertex 7 of 7");
    memcpy(broken, vertices, sizeof broken);
    broken[20] = NAN;
    bad = mesh();
    bad.vertices = broken;
    WRONG(lightbuffer_scene_new(&bad, 1, &scene), "meshes[0]: vertex 6 is not finite");
    broken[20] = -INFINITY;
    WRONG(lightbuffer_scene_new(&bad, 1, &scene), "meshes[0]: vertex 6 is not finite");
    memcpy(outside, triangles, sizeof outside);
    outside[3] = UINT32_MAX;
    bad = mesh();
    bad.triangles = outside;
    WRONG(lightbuffer_scene_new(&bad, 1, &scene), "triangle 1 has vertex 4294967295 of 8");
    bad = mesh();
    bad.triangles = triangles + 6;
    bad.triangle_count = 1;
    WRONG(lightbuffer_scene_new(&bad, 1, &scene), "1 were given, and none has an area");
    CHECK(scene == untouched);
    lightbuffer_scene_free(NULL);
    CHECK(lightbuffer_scene_dropped_triangles(NULL) == 0);
}

static void bad_testers(const lightbuffer_scene *scene)
{
    lightbuffer_tester *const untouched = (lightbuffer_tester *)(void *)&failures;
    lightbuffer_tester *tester = untouched;
    const lightbuffer_settings usual = {NULL, 0, 0, 1, 0, 0};
    lightbuffer_settings settings = usual;
    lightbuffer_light light = above;
    WRONG(lightbuffer_tester_new(NULL, &light, NULL, &tester), "scene is NULL");
    WRONG(lightbuffer_tester_new(scene, NULL, NULL, &tester), "light is NULL");
    WRONG(lightbuffer_tester_new(scene, &light, NULL, NULL), "tester is NULL");
    light.vector[1] = NAN;
    WRONG(lightbuffer_tester_new(scene, &light, &settings, &tester), "light.vector is not finite");
    light = above;
    light.kind = 7;
    WRONG(lightbuffer_tester_new(scene, &light, &settings, &tester), "light.kind is 7");
    memset(&light, 0, sizeof light);
    light.kind = LIGHTBUFFER_LIGHT_DIRECTIONAL;
    WRONG(lightbuffer_tester_new(scene, &light, &settings, &tester), "directional light is zero");
    light = above;
    settings.tester = "nobody";
    WRONG(lightbuffer_tester_new(scene, &light, &settings, &tester), "no shadow tester `nobody`");
    WRONG(lightbuffer_tester_new(scene, &light, &settings, &tester), "light-buffer");
    settings.tester = "two\nlines\xff";
    WRONG(lightbuffer_tester_new(scene, &light, &settings, &tester), "no shadow tester `two\\nlines");
    settings.tester = "shadow-buffer";
    REFUSED(lightbuffer_tester_new(scene, &sun, &settings, &tester), "shadow-buffer has no answer for lights that are");
    settings = usual;
    settings.tester = "light-buffer";
    settings.resolution = 4097;
    WRONG(lightbuffer_tester_new(scene, &light, &settings, &tester), "settings.resolution is 4097");
    settings.resolution = 4096;
    settings.memory_limit = 1000;
    REFUSED(lightbuffer_tester_new(scene, &light, &settings, &tester), "the memory limit is 1 KiB");
    settings = usual;
    settings.threads = 1025;
    WRONG(lightbuffer_tester_new(scene, &light, &settings, &tester), "1025 threads");
    settings = usual;
    settings.receivers = 2;
    WRONG(lightbuffer_tester_new(scene, &light, &settings, &tester), "settings.receivers is 2");
    settings = usual;
    settings.reserved = 1;
    WRONG(lightbuffer_tester_new(scene, &light, &settings, &tester), "settings.reserved is 1");
    CHECK(tester == untouched);
    lightbuffer_tester_free(NULL);
    CHECK(lightbuffer_tester_bytes(NULL) == 0);
}

static void bad_questions(const lightbuffer_scene *scene)
{
    lightbuffer_settings settings = {"light-buffer", 0, 8, 1, LIGHTBUFFER_SURFACES, 0};
    lightbuffer_tester *tester = NULL;
    lightbuffer_ray broken[RAYS];
    uint32_t found[RAYS], others[RAYS];
    uint8_t answers[RAYS], untouched[RAYS];
    float nowhere[3] = {0, 0, NAN};
    memset(untouched, 77, sizeof untouched);
    memcpy(answers, untouched, sizeof answers);
    memset(found, 77, sizeof found);
    memcpy(others, found, sizeof others);
    FINE(lightbuffer_tester_new(scene, &above, &settings, &tester));

    WRONG(lightbuffer_occluded(NULL, rays, NULL, RAYS, answers), "tester is NULL");
    WRONG(lightbuffer_occluded(tester, NULL, NULL, RAYS, answers), "rays is NULL");
    WRONG(lightbuffer_occluded(tester, rays, NULL, RAYS, NULL), "answers is NULL");
    WRONG(lightbuffer_occluded(tester, rays, NULL, UINT64_MAX / 2, answers), "no memory holds so many");
    memcpy(broken, rays, sizeof broken);
    broken[4].direction[1] = INFINITY;
    WRONG(lightbuffer_occluded(tester, broken, NULL, RAYS, answers), "rays[4] is not finite");
    WRONG(lightbuffer_first_hits(scene, 1, broken, RAYS, found), "rays[4] is not finite");
    broken[3].direction[1] = -0.0f;
    WRONG(lightbuffer_occluded(tester, broken, NULL, RAYS, answers), "rays[3] has no direction");
    WRONG(lightbuffer_first_hits(scene, 1, broken, RAYS, found), "rays[3] has no direction");
    WRONG(lightbuffer_first_hits(NULL, 1, rays, RAYS, found), "scene is NULL");
    WRONG(lightbuffer_first_hits(scene, 1, rays, RAYS, NULL), "triangles is NULL");
    WRONG(lightbuffer_first_hits(scene, 9999, rays, RAYS, found), "9999 threads");
    CHECK(memcmp(found, others, sizeof found) == 0);
    memcpy(found, hits, sizeof found);
    found[2] = 5;
    WRONG(lightbuffer_occluded(tester, rays, found, RAYS, answers), "triangles[2] is 5, and the scene has 5");
    found[2] = 2;
    WRONG(lightbuffer_occluded(tester, rays, found, RAYS, answers), "triangles[2] is 2, and that has no area");
    found[2] = 0;
    WRONG(lightbuffer_occluded(tester, rays, found, RAYS, answers), "triangles[2] is 0, and rays[2] does not hit it");
    REFUSED(lightbuffer_occluded_at(tester, points, 4, answers), "built for points on surfaces");
    lightbuffer_tester_free(tester);

    settings.receivers = LIGHTBUFFER_ANYWHERE;
    FINE(lightbuffer_tester_new(scene, &above, &settings, &tester));
    WRONG(lightbuffer_occluded_at(tester, NULL, 4, answers), "points is NULL");
    WRONG(lightbuffer_occluded_at(tester, points, 4, NULL), "answers is NULL");
    WRONG(lightbuffer_occluded_at(tester, nowhere, 1, answers), "points[0] is not finite");
    CHECK(memcmp(answers, untouched, sizeof answers) == 0);
    /* After all that, and of nothing at all. */
    FINE(lightbuffer_occluded_at(tester, NULL, 0, NULL));
    FINE(lightbuffer_occluded(tester, NULL, NULL, 0, NULL));
    FINE(lightbuffer_first_hits(scene, 1, NULL, 0, NULL));
    FINE(lightbuffer_occluded(tester, rays, hits, RAYS, answers));
    CHECK(memcmp(answers, answers_above, sizeof answers) == 0);
    CHECK(lightbuffer_error_text()[0] == '\0');
    lightbuffer_tester_free(tester);
}

/* Every tester that is exact, for both kinds of light; `embree` too where asked for, since nothing here is on an edge. */
static void every_tester(const lightbuffer_scene *scene, int count, char **names)
{
    int i;
    for (i = 0; i < count; i++) {
        lightbuffer_settings settings = {NULL, 0, 0, 2, LIGHTBUFFER_ANYWHERE, 0};
        lightbuffer_tester *tester = NULL;
        uint8_t answers[RAYS];
        uint32_t found[RAYS];
        settings.tester = names[i];
        FINE(lightbuffer_tester_new(scene, &above, &settings, &tester));
        FINE(lightbuffer_occluded(tester, rays, NULL, RAYS, answers));
        if (memcmp(answers, answers_above, sizeof answers) != 0) {
            fprintf(stderr, "%s: other answers\n", names[i]);
            failures++;
        }
        FINE(lightbuffer_first_hits(scene, 0, rays, RAYS, found));
        CHECK(memcmp(found, hits, sizeof found) == 0);
        FINE(lightbuffer_occluded(tester, rays, found, RAYS, answers));
        CHECK(memcmp(answers, answers_above, sizeof answers) == 0);
        FINE(lightbuffer_occluded_at(tester, points, 4, answers));
        CHECK(memcmp(answers, answers_at, 4) == 0);
        CHECK(lightbuffer_tester_bytes(tester) < 1u << 30);
        lightbuffer_tester_free(tester);
        FINE(lightbuffer_tester_new(scene, &sun, &settings, &tester));
        FINE(lightbuffer_occluded(tester, rays, hits, RAYS, answers));
        CHECK(answers[0] == LIGHTBUFFER_OCCLUDED && answers[1] == LIGHTBUFFER_LIT && answers[5] == LIGHTBUFFER_FACES_AWAY);
        lightbuffer_tester_free(tester);
    }
}

static void *ask_often(void *tester)
{
    int i;
    for (i = 0; i < 40; i++) {
        uint8_t answers[RAYS] = {9, 9, 9, 9, 9, 9};
        if (lightbuffer_occluded(tester, rays, NULL, RAYS, answers) != LIGHTBUFFER_OK
            || memcmp(answers, answers_above, sizeof answers) != 0
            || lightbuffer_occluded_at(tester, points, 4, answers) != LIGHTBUFFER_OK
            || memcmp(answers, answers_at, 4) != 0) {
            return tester;
        }
        /* The text of an error is that of its thread. */
        if (lightbuffer_occluded(NULL, rays, NULL, RAYS, answers) == LIGHTBUFFER_OK
            || strcmp(lightbuffer_error_text(), "tester is NULL") != 0) {
            return tester;
        }
    }
    return NULL;
}

static void many_threads(lightbuffer_scene *scene)
{
    const lightbuffer_settings settings = {"auto", 0, 0, 2, LIGHTBUFFER_ANYWHERE, 0};
    lightbuffer_tester *tester = NULL;
    pthread_t threads[8];
    int i;
    FINE(lightbuffer_tester_new(scene, &above, &settings, &tester));
    /* The tester outlives the handle of its scene. */
    lightbuffer_scene_free(scene);
    for (i = 0; i < 8; i++) {
        CHECK(pthread_create(&threads[i], NULL, ask_often, tester) == 0);
    }
    for (i = 0; i < 8; i++) {
        void *wrong = NULL;
        CHECK(pthread_join(threads[i], &wrong) == 0);
        CHECK(wrong == NULL);
    }
    CHECK(lightbuffer_error_text()[0] == '\0');
    lightbuffer_tester_free(tester);
}

int main(int count, char **names)
{
    lightbuffer_scene *scene = scene_of();
    CHECK(strcmp(lightbuffer_version(), LIGHTBUFFER_VERSION) == 0);
    CHECK(lightbuffer_scene_dropped_triangles(scene) == 1);
    bad_scenes();
    bad_testers(scene);
    bad_questions(scene);
    every_tester(scene, count - 1, names + 1);
    many_threads(scene);
    printf("%d failures\n", failures);
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
