/*
 * A square hangs over a floor, and a light over both: which points of the floor does the light see?
 *
 *     make c-library
 *     export PKG_CONFIG_PATH=$PWD/target/c/lib/pkgconfig
 *     cc examples/c/occlusion.c $(pkg-config --cflags --libs lightbuffer) -Wl,-rpath,$PWD/target/c/lib -o target/occlusion
 *     target/occlusion
 */
#include <lightbuffer.h>
#include <stdio.h>
#include <stdlib.h>

/* So many rays a side, straight down from between the two. */
#define SIDE 128

static const float floor_vertices[] = {-4, 0, -4, 4, 0, -4, 4, 0, 4, -4, 0, 4};
static const float square_vertices[] = {-1, 1, -1, 1, 1, -1, 1, 1, 1, -1, 1, 1};
static const uint32_t two_triangles[] = {0, 1, 2, 0, 2, 3};

static int failed(const char *what)
{
    fprintf(stderr, "%s: %s\n", what, lightbuffer_error_text());
    return EXIT_FAILURE;
}

static void count(const char *what, const uint8_t *answers, size_t number)
{
    static const char *const names[] = {"lit", "occluded", "facing away", "without a surface"};
    unsigned long counts[4] = {0, 0, 0, 0};
    size_t i;
    int k;
    for (i = 0; i < number; i++) {
        counts[answers[i]]++;
    }
    printf("%s:", what);
    for (k = 0; k < 4; k++) {
        printf(" %lu %s%s", counts[k], names[k], k < 3 ? "," : "\n");
    }
}

int main(void)
{
    static lightbuffer_ray rays[SIDE * SIDE];
    static uint8_t answers[SIDE * SIDE];
    const float in_space[] = {0.5f, 0.5f, 0.5f, 0.5f, 1.5f, 0.5f, 3.5f, 0.5f, 0.5f};
    lightbuffer_mesh meshes[2];
    lightbuffer_light light = {LIGHTBUFFER_LIGHT_POINT, {0, 3, 0}};
    lightbuffer_settings settings = {NULL, 0, LIGHTBUFFER_RESOLUTION_AUTO, 2, LIGHTBUFFER_ANYWHERE, 0};
    lightbuffer_scene *scene = NULL;
    lightbuffer_tester *tester = NULL;
    size_t i;

    meshes[0].vertices = floor_vertices;
    meshes[1].vertices = square_vertices;
    for (i = 0; i < 2; i++) {
        meshes[i].vertex_count = 4;
        meshes[i].triangles = two_triangles;
        meshes[i].triangle_count = 2;
    }
    if (lightbuffer_scene_new(meshes, 2, &scene) != LIGHTBUFFER_OK) {
        return failed("scene");
    }
    settings.tester = "light-buffer";
    if (lightbuffer_tester_new(scene, &light, &settings, &tester) != LIGHTBUFFER_OK) {
        return failed("tester");
    }
    /* The tester keeps what it needs of the scene. */
    lightbuffer_scene_free(scene);

    for (i = 0; i < SIDE * SIDE; i++) {
        rays[i].origin[0] = 10.0f * ((float)(i % SIDE) + 0.5f) / SIDE - 5.0f;
        rays[i].origin[1] = 0.5f;
        rays[i].origin[2] = 10.0f * ((float)(i / SIDE) + 0.5f) / SIDE - 5.0f;
        rays[i].direction[0] = 0.0f;
        rays[i].direction[1] = -1.0f;
        rays[i].direction[2] = 0.0f;
    }
    printf("lightbuffer %s\n", lightbuffer_version());
    if (lightbuffer_occluded(tester, rays, NULL, SIDE * SIDE, answers) != LIGHTBUFFER_OK) {
        return failed("rays");
    }
    count("where rays hit", answers, SIDE * SIDE);
    if (lightbuffer_occluded_at(tester, in_space, 3, answers) != LIGHTBUFFER_OK) {
        return failed("points");
    }
    count("points in space", answers, 3);
    lightbuffer_tester_free(tester);
    return EXIT_SUCCESS;
}
