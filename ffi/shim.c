/* Errors, devices and scenes of shim.h, for Embree 3 and Embree 4. See README.md. */

#include "internal.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- The floating-point control word ---- */

#if defined(__x86_64__)
#include <xmmintrin.h>
static FloatControl save_float_control(void) { return _mm_getcsr(); }
static void restore_float_control(FloatControl saved) { _mm_setcsr(saved); }
bool lb_choose_denormals(bool flush)
{
    enum { FLUSH_TO_ZERO = 1 << 15, DENORMALS_ARE_ZERO = 1 << 6 };
    const unsigned int both = FLUSH_TO_ZERO | DENORMALS_ARE_ZERO;
    _mm_setcsr(flush ? _mm_getcsr() | both : _mm_getcsr() & ~both);
    return true;
}
#else
static FloatControl save_float_control(void)
{
    fenv_t environment;
    fegetenv(&environment);
    return environment;
}
static void restore_float_control(FloatControl saved) { fesetenv(&saved); }
bool lb_choose_denormals(bool flush)
{
    (void)flush;
    return false;
}
#endif

/* ---- Errors ---- */

enum { STRAY_NONE = 0, STRAY_WRITING = 1, STRAY_STORED = 2 };

/*
 * Embree raises errors on the thread that called it. The error of a call is therefore gathered a thread, so that two
 * threads on one device never see each other's.
 */
static _Thread_local LbError *call_error = NULL;

static const char *error_name(enum RTCError code)
{
    switch (code) {
    case RTC_ERROR_NONE: return "no error";
    case RTC_ERROR_INVALID_ARGUMENT: return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION: return "invalid operation";
    case RTC_ERROR_OUT_OF_MEMORY: return "out of memory";
    case RTC_ERROR_UNSUPPORTED_CPU: return "unsupported processor";
    case RTC_ERROR_CANCELLED: return "cancelled";
    default: return "unknown error";
    }
}

__attribute__((format(printf, 2, 3))) static void write_error(LbError *error, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    for (char *c = error->text; *c; c++) {
        if (*c == '\n' || *c == '\r')
            *c = ' ';
    }
}

/* Keeps the first error only: later ones are mostly its consequences. */
static void on_embree_error(void *user, enum RTCError code, const char *text)
{
    if (call_error) {
        if (!call_error->text[0])
            write_error(call_error, "%s: %s", error_name(code), text ? text : "no description");
        return;
    }
    LbDevice *device = user;
    int none = STRAY_NONE;
    if (atomic_compare_exchange_strong(&device->stray_state, &none, STRAY_WRITING)) {
        write_error(&device->stray, "%s: %s", error_name(code), text ? text : "no description");
        atomic_store(&device->stray_state, STRAY_STORED);
    }
}

Call lb_begin_call(LbError *error)
{
    error->text[0] = 0;
    call_error = error;
    return (Call){ error, save_float_control() };
}

uint32_t lb_end_call(Call call, LbDevice *device)
{
    restore_float_control(call.float_control);
    call_error = NULL;
    if (device && !call.error->text[0]) {
        int stored = STRAY_STORED;
        if (atomic_compare_exchange_strong(&device->stray_state, &stored, STRAY_WRITING)) {
            *call.error = device->stray;
            atomic_store(&device->stray_state, STRAY_NONE);
        }
    }
    return call.error->text[0] ? LB_FAILED : LB_OK;
}

void lb_fail(Call call, const char *text)
{
    if (!call.error->text[0])
        write_error(call.error, "%s", text);
}

/* ---- Device ---- */

static bool on_memory(void *user, ssize_t bytes, bool post)
{
    (void)post;
    LbDevice *device = user;
    atomic_fetch_add(&device->bytes, (int64_t)bytes);
    return true;
}

uint32_t lb_property(const LbDevice *device, enum RTCDeviceProperty name)
{
    return (uint32_t)rtcGetDeviceProperty(device->handle, name);
}

bool lb_has_streams(const LbDevice *device)
{
#if LB_EMBREE_MAJOR == 3
    return lb_property(device, RTC_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED);
#else
    (void)device;
    return false;
#endif
}

/* What would make the answers those of another Embree than the one this shim was written for. */
static void check_device(Call call, const LbDevice *device)
{
    uint32_t major = lb_property(device, RTC_DEVICE_PROPERTY_VERSION_MAJOR);
    if (major != RTC_VERSION_MAJOR && !call.error->text[0])
        write_error(call.error, "compiled against headers of version %d but version %u was loaded", RTC_VERSION_MAJOR,
                    (unsigned)major);
    if (lb_property(device, RTC_DEVICE_PROPERTY_BACKFACE_CULLING_ENABLED))
        lb_fail(call, "this Embree culls back faces, so it cannot tell what casts a shadow");
    if (!lb_property(device, RTC_DEVICE_PROPERTY_TRIANGLE_GEOMETRY_SUPPORTED))
        lb_fail(call, "this Embree was built without triangles");
}

uint32_t lb_device_new(uint32_t threads, LbDevice **device_out, LbError *error)
{
    Call call = lb_begin_call(error);
    *device_out = NULL;
    LbDevice *device = calloc(1, sizeof *device);
    if (!device) {
        lb_fail(call, "no memory for a device");
        return lb_end_call(call, NULL);
    }
    char config[32];
    snprintf(config, sizeof config, "threads=%u", (unsigned)threads);
    device->handle = rtcNewDevice(config);
    if (!device->handle) {
        /* There is no device that could have called the error function, so the code is all there is. */
        write_error(call.error, "no device: %s", error_name(rtcGetDeviceError(NULL)));
        free(device);
        return lb_end_call(call, NULL);
    }
    rtcSetDeviceErrorFunction(device->handle, on_embree_error, device);
    rtcSetDeviceMemoryMonitorFunction(device->handle, on_memory, device);
    check_device(call, device);
    if (call.error->text[0]) {
        rtcReleaseDevice(device->handle);
        free(device);
        return lb_end_call(call, NULL);
    }
    *device_out = device;
    return lb_end_call(call, device);
}

uint32_t lb_device_free(LbDevice *device, LbError *error)
{
    Call call = lb_begin_call(error);
    rtcReleaseDevice(device->handle);
    free(device);
    return lb_end_call(call, NULL);
}

uint32_t lb_device_info(const LbDevice *device, LbDeviceInfo *info, LbError *error)
{
    Call call = lb_begin_call(error);
    info->version_major = lb_property(device, RTC_DEVICE_PROPERTY_VERSION_MAJOR);
    info->version_minor = lb_property(device, RTC_DEVICE_PROPERTY_VERSION_MINOR);
    info->version_patch = lb_property(device, RTC_DEVICE_PROPERTY_VERSION_PATCH);
    info->native_packet_4 = lb_property(device, RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED);
    info->native_packet_8 = lb_property(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED);
    info->native_packet_16 = lb_property(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED);
    info->streams = lb_has_streams(device);
    /* Tried, because the answer is the platform's and lb_end_call undoes it. */
    info->flushes_denormals = lb_choose_denormals(false);
    return lb_end_call(call, NULL);
}

uint32_t lb_device_bytes(LbDevice *device, int64_t *bytes, LbError *error)
{
    Call call = lb_begin_call(error);
    *bytes = atomic_load(&device->bytes);
    return lb_end_call(call, device);
}

/* ---- Scene ---- */

static enum RTCBuildQuality build_quality(uint32_t quality)
{
    switch (quality) {
    case LB_BUILD_LOW: return RTC_BUILD_QUALITY_LOW;
    case LB_BUILD_HIGH: return RTC_BUILD_QUALITY_HIGH;
    default: return RTC_BUILD_QUALITY_MEDIUM;
    }
}

/* Null if it cannot be made; the caller owns it. */
static RTCGeometry new_mesh(Call call, LbScene *scene)
{
    const LbDevice *device = scene->device;
    const LbParts *parts = &scene->parts;
    RTCGeometry mesh = rtcNewGeometry(device->handle, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!mesh) {
        lb_fail(call, "no geometry");
        return NULL;
    }
    rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, parts->vertices, 0,
                               3 * sizeof(float), parts->vertex_count);
    rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, parts->triangles, 0,
                               3 * sizeof(uint32_t), parts->triangle_count);
    if (scene->filtered || scene->has_holes || parts->transparent) {
        if (!lb_property(device, RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED))
            lb_fail(call, "this Embree was built without filter functions, so no hit can be rejected");
        rtcSetGeometryUserData(mesh, scene);
        rtcSetGeometryOccludedFilterFunction(mesh, lb_reject_hits);
    }
    return mesh;
}

/* Puts a geometry, which may be null, into its scene and gives up the caller's part in it. */
static void attach(LbScene *scene, RTCGeometry geometry, uint32_t quality)
{
    if (!geometry)
        return;
    /* Low quality builds a tree a geometry, by the geometry's own setting; the others follow the scene's. */
    rtcSetGeometryBuildQuality(geometry, build_quality(quality));
    /* The default of Embree 3 is all bits, that of Embree 4 is the lowest. */
    rtcSetGeometryMask(geometry, 0xFFFFFFFFu);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene->handle, geometry);
    rtcReleaseGeometry(geometry);
}

uint32_t lb_scene_new(LbDevice *device, const LbParts *parts, uint32_t quality, uint32_t flags, LbScene **scene_out,
                      LbError *error)
{
    Call call = lb_begin_call(error);
    *scene_out = NULL;
    LbScene *scene = calloc(1, sizeof *scene);
    if (!scene) {
        lb_fail(call, "no memory for a scene");
        return lb_end_call(call, device);
    }
    scene->device = device;
    scene->filtered = flags & LB_SCENE_FILTERED;
    scene->parts = *parts;
    scene->has_holes = parts->holes != NULL;
    if (parts->holes)
        scene->holes = *parts->holes;
    scene->handle = rtcNewScene(device->handle);
    if (!scene->handle) {
        lb_fail(call, "no scene");
        free(scene);
        return lb_end_call(call, device);
    }
    rtcSetSceneBuildQuality(scene->handle, build_quality(quality));
    if (flags & LB_SCENE_ROBUST)
        rtcSetSceneFlags(scene->handle, RTC_SCENE_FLAG_ROBUST);
    /* A scene of nothing is one of a mesh without triangles. */
    if (parts->triangle_count || !parts->curved_count)
        attach(scene, new_mesh(call, scene), quality);
    if (parts->curved_count)
        attach(scene, lb_new_curved(call, scene), quality);
    /* A scene over a geometry that Embree has refused must not be built. */
    if (!call.error->text[0])
        rtcCommitScene(scene->handle);
    uint32_t status = lb_end_call(call, device);
    if (status != LB_OK) {
        LbError ignored;
        lb_scene_free(scene, &ignored);
        return status;
    }
    *scene_out = scene;
    return LB_OK;
}

uint32_t lb_scene_free(LbScene *scene, LbError *error)
{
    Call call = lb_begin_call(error);
    LbDevice *device = scene->device;
    rtcReleaseScene(scene->handle);
    free(scene);
    return lb_end_call(call, device);
}
