/* Messages for Vulkan results, and Vulkan's formats. */
#include "gpu.h"

#include <stdlib.h>

/* The drivers are those that the loader finds, or those that a variable of the environment names. */
bool vk_fail_no_driver(struct glint_error *err) {
    static const char *const variables[] = {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"};
    for (size_t i = 0; i < sizeof variables / sizeof *variables; i++) {
        const char *set = getenv(variables[i]);
        if (set && *set)
            return glint_fail(err, GLINT_ERROR_DEVICE,
                              "no Vulkan driver found: %s=%s names none that works; unset it, or let it name the .json "
                              "file of a driver (Debian: those of mesa-vulkan-drivers)",
                              variables[i], set);
    }
    return glint_fail(err, GLINT_ERROR_DEVICE,
                      "no Vulkan driver found: install one (Debian: apt install mesa-vulkan-drivers, which needs no "
                      "GPU), or set VK_DRIVER_FILES to the .json file of an installed one");
}

bool vk_fail(struct glint_error *err, const char *what, VkResult result) {
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) return vk_fail_no_driver(err);
    static const struct {
        VkResult result;
        const char *word;
    } words[] = {
        {VK_ERROR_OUT_OF_HOST_MEMORY, "out of host memory"},
        {VK_ERROR_OUT_OF_DEVICE_MEMORY, "out of device memory"},
        {VK_ERROR_DEVICE_LOST, "the device was lost"},
        {VK_ERROR_INITIALIZATION_FAILED, "initialisation failed"},
        {VK_ERROR_LAYER_NOT_PRESENT, "layer not installed"},
        {VK_ERROR_FEATURE_NOT_PRESENT, "feature not present"},
        {VK_ERROR_EXTENSION_NOT_PRESENT, "extension not present"},
    };
    const bool memory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
    const char *word = "an unexpected result";
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (words[i].result == result) word = words[i].word;
    return glint_fail(err, memory ? GLINT_ERROR_MEMORY : GLINT_ERROR_DEVICE, "Vulkan: %s: %s (%d)", what, word,
                      (int)result);
}

bool vk_ok(VkResult result, const char *what, struct glint_error *err) {
    return result == VK_SUCCESS || vk_fail(err, what, result);
}

bool gpu_fail(struct gpu *gpu, struct glint_error *err, const char *what, VkResult result) {
    gpu->lost |= result == VK_ERROR_DEVICE_LOST;
    return vk_fail(err, what, result);
}

bool gpu_ok(struct gpu *gpu, VkResult result, const char *what, struct glint_error *err) {
    return result == VK_SUCCESS || gpu_fail(gpu, err, what, result);
}

VkFormat format_vulkan(enum glint_format format) {
    static const VkFormat formats[] = {
        [GLINT_FORMAT_R8UI] = VK_FORMAT_R8_UINT,
        [GLINT_FORMAT_R32UI] = VK_FORMAT_R32_UINT,
        [GLINT_FORMAT_R16F] = VK_FORMAT_R16_SFLOAT,
        [GLINT_FORMAT_RG16F] = VK_FORMAT_R16G16_SFLOAT,
        [GLINT_FORMAT_RGBA16F] = VK_FORMAT_R16G16B16A16_SFLOAT,
        [GLINT_FORMAT_R32F] = VK_FORMAT_R32_SFLOAT,
        [GLINT_FORMAT_RG32F] = VK_FORMAT_R32G32_SFLOAT,
        [GLINT_FORMAT_RGBA32F] = VK_FORMAT_R32G32B32A32_SFLOAT,
    };
    return formats[format];
}
