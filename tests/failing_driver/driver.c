/* A Vulkan driver for tests: the one of WELKIN_TEST_DRIVER, but that calls of WELKIN_TEST_CALL (a device's function that returns a
 * VkResult) return WELKIN_TEST_RESULT, a number, after WELKIN_TEST_AFTER calls that the real driver has answered. */
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void (*Function)(void);
typedef Function (*GetFunction)(void *object, const char *name);
/* No function that is asked to fail has more arguments, all of them integers or pointers. */
typedef int32_t (*Call)(uintptr_t, uintptr_t, uintptr_t, uintptr_t, uintptr_t, uintptr_t);

static void *driver;
static GetFunction real_get_device_function;
static Call real_call;
static long calls_left;
static void *device_in_use;
static const int32_t DEVICE_LOST = -4;

static Function of_driver(const char *name) {
    if (!driver && !(driver = dlopen(getenv("WELKIN_TEST_DRIVER"), RTLD_NOW | RTLD_LOCAL))) {
        fprintf(stderr, "%s\n", dlerror());
        abort();
    }
    Function found;
    *(void **)&found = dlsym(driver, name);
    return found;
}

static int32_t failing(uintptr_t a, uintptr_t b, uintptr_t c, uintptr_t d, uintptr_t e, uintptr_t f) {
    if (calls_left-- > 0) {
        return real_call(a, b, c, d, e, f);
    }
    int32_t result = (int32_t)atoi(getenv("WELKIN_TEST_RESULT"));
    /* A lost device works no more: nothing that is destroyed after this is in use. */
    if (result == DEVICE_LOST) {
        ((int32_t(*)(void *))real_get_device_function(device_in_use, "vkDeviceWaitIdle"))(device_in_use);
    }
    return result;
}

static Function get_device_function(void *device, const char *name) {
    Function found = real_get_device_function(device, name);
    if (found && strcmp(name, getenv("WELKIN_TEST_CALL")) == 0) {
        real_call = (Call)found;
        device_in_use = device;
        calls_left = atol(getenv("WELKIN_TEST_AFTER"));
        return (Function)failing;
    }
    return found;
}

int32_t vk_icdNegotiateLoaderICDInterfaceVersion(uint32_t *version) {
    return ((int32_t(*)(uint32_t *))of_driver("vk_icdNegotiateLoaderICDInterfaceVersion"))(version);
}

Function vk_icdGetPhysicalDeviceProcAddr(void *instance, const char *name) {
    return ((GetFunction)of_driver("vk_icdGetPhysicalDeviceProcAddr"))(instance, name);
}

Function vk_icdGetInstanceProcAddr(void *instance, const char *name) {
    Function found = ((GetFunction)of_driver("vk_icdGetInstanceProcAddr"))(instance, name);
    if (found && strcmp(name, "vkGetDeviceProcAddr") == 0) {
        real_get_device_function = (GetFunction)found;
        return (Function)get_device_function;
    }
    return found;
}
