/*
 * Asks the C interface about what a file holds, and writes all answers to another:
 *
 *     million INPUT OUTPUT TESTER
 *
 * Input: four uint64_t (vertices, triangles, rays, points), the light as three floats, then the vertices, triangles, rays and
 * points. Output: the first hit of each ray; answers of each ray where the library finds its triangle; answers of each ray for
 * these triangles, asked by four threads at once; answers of each point.
 */
#include <lightbuffer.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

#define THREADS 4

struct part {
    const lightbuffer_tester *tester;
    const lightbuffer_ray *rays;
    const uint32_t *triangles;
    uint8_t *answers;
    uint64_t first, last;
    int32_t code;
};

static void must(int holds, const char *what)
{
    if (!holds) {
        fprintf(stderr, "%s: %s\n", what, lightbuffer_error_text());
        exit(EXIT_FAILURE);
    }
}

static void *read_array(FILE *file, uint64_t count, size_t size)
{
    void *array = malloc(count * size + 1);
    must(array != NULL && fread(array, size, count, file) == count, "input");
    return array;
}

static void write_array(FILE *file, const void *array, uint64_t count, size_t size)
{
    must(fwrite(array, size, count, file) == count, "output");
}

/* Portions of odd sizes, one after the other. */
static void *ask_part(void *argument)
{
    struct part *part = argument;
    uint64_t first = part->first;
    while (first < part->last && part->code == LIGHTBUFFER_OK) {
        const uint64_t left = part->last - first, number = left < 77777 ? left : 77777;
        part->code = lightbuffer_occluded(part->tester, part->rays + first, part->triangles + first, number,
                                          part->answers + first);
        first += number;
    }
    return NULL;
}

int main(int count, char **arguments)
{
    uint64_t *counts, rays;
    lightbuffer_mesh mesh;
    lightbuffer_light light;
    lightbuffer_settings settings = {NULL, 0, LIGHTBUFFER_RESOLUTION_AUTO, LIGHTBUFFER_ALL_THREADS, LIGHTBUFFER_ANYWHERE, 0};
    lightbuffer_scene *scene = NULL;
    lightbuffer_tester *tester = NULL;
    lightbuffer_ray *all_rays;
    float *points, *position;
    uint32_t *hits;
    uint8_t *answers;
    pthread_t threads[THREADS];
    struct part parts[THREADS];
    FILE *file;
    int i;

    must(count == 4, "usage: million INPUT OUTPUT TESTER");
    file = fopen(arguments[1], "rb");
    must(file != NULL, arguments[1]);
    counts = read_array(file, 4, sizeof *counts);
    position = read_array(file, 3, sizeof *position);
    mesh.vertex_count = counts[0];
    mesh.triangle_count = counts[1];
    rays = counts[2];
    mesh.vertices = read_array(file, 3 * counts[0], sizeof(float));
    mesh.triangles = read_array(file, 3 * counts[1], sizeof(uint32_t));
    all_rays = read_array(file, rays, sizeof *all_rays);
    points = read_array(file, 3 * counts[3], sizeof *points);
    fclose(file);

    must(lightbuffer_scene_new(&mesh, 1, &scene) == LIGHTBUFFER_OK, "scene");
    /* All is copied. */
    free((void *)mesh.vertices);
    free((void *)mesh.triangles);
    light.kind = LIGHTBUFFER_LIGHT_POINT;
    for (i = 0; i < 3; i++) {
        light.vector[i] = position[i];
    }
    settings.tester = arguments[3];
    must(lightbuffer_tester_new(scene, &light, &settings, &tester) == LIGHTBUFFER_OK, "tester");

    file = fopen(arguments[2], "wb");
    must(file != NULL, arguments[2]);
    hits = malloc(rays * sizeof *hits);
    answers = malloc(rays > counts[3] ? rays : counts[3]);
    must(hits != NULL && answers != NULL, "memory");
    must(lightbuffer_first_hits(scene, settings.threads, all_rays, rays, hits) == LIGHTBUFFER_OK, "first hits");
    write_array(file, hits, rays, sizeof *hits);
    must(lightbuffer_occluded(tester, all_rays, NULL, rays, answers) == LIGHTBUFFER_OK, "rays");
    write_array(file, answers, rays, 1);
    for (i = 0; i < THREADS; i++) {
        struct part part = {NULL, NULL, NULL, NULL, 0, 0, LIGHTBUFFER_OK};
        part.tester = tester;
        part.rays = all_rays;
        part.triangles = hits;
        part.answers = answers;
        part.first = rays * (uint64_t)i / THREADS;
        part.last = rays * (uint64_t)(i + 1) / THREADS;
        parts[i] = part;
        must(pthread_create(&threads[i], NULL, ask_part, &parts[i]) == 0, "thread");
    }
    for (i = 0; i < THREADS; i++) {
        must(pthread_join(threads[i], NULL) == 0 && parts[i].code == LIGHTBUFFER_OK, "rays of a thread");
    }
    write_array(file, answers, rays, 1);
    must(lightbuffer_occluded_at(tester, points, counts[3], answers) == LIGHTBUFFER_OK, "points");
    write_array(file, answers, counts[3], 1);
    must(fclose(file) == 0, arguments[2]);

    lightbuffer_tester_free(tester);
    lightbuffer_scene_free(scene);
    free(counts);
    free(position);
    free(all_rays);
    free(points);
    free(hits);
    free(answers);
    return EXIT_SUCCESS;
}
