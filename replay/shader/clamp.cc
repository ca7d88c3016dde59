/* Shaders whose indices cannot leave arrays: a shim around a pass of SPIRV-Tools. */
#include "clamp.h"

#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

#include <spirv-tools/optimizer.hpp>

static std::vector<uint32_t> clamped(const uint32_t *words, size_t bytes) {
    std::vector<uint32_t> out;
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    optimizer.RegisterPass(spvtools::CreateGraphicsRobustAccessPass());
    if (!optimizer.Run(words, bytes / sizeof *words, &out)) out.clear();
    return out;
}

uint32_t *spirv_clamp(const uint32_t *words, size_t bytes, size_t *clamped_bytes) {
    try {
        const std::vector<uint32_t> found = clamped(words, bytes);
        *clamped_bytes = found.size() * sizeof *words;
        uint32_t *copy = found.empty() ? nullptr : static_cast<uint32_t *>(std::malloc(*clamped_bytes));
        if (copy) std::memcpy(copy, found.data(), *clamped_bytes);
        return copy;
    } catch (const std::exception &) {
        return nullptr;
    }
}
