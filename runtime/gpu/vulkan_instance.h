#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <dlfcn.h>

#include <fmt/format.h>

#include "runtime/gpu/device.h"
#include "runtime/gpu/vulkan_api.h"

namespace graftal {

namespace vulkan {

struct Api {
#define GRAFTAL_MEMBER(name) PFN_##name name = nullptr;
    GRAFTAL_VULKAN_FUNCTIONS(GRAFTAL_MEMBER)
#undef GRAFTAL_MEMBER
};

/// The loader's entry; null where there is none. It stays loaded.
inline PFN_vkGetInstanceProcAddr loader() {
    static const PFN_vkGetInstanceProcAddr entry = []() -> PFN_vkGetInstanceProcAddr {
        for (const char* const name : {"libvulkan.so.1", "libvulkan.1.dylib"})
            if (void* const library = dlopen(name, RTLD_NOW | RTLD_LOCAL))
                return reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vkGetInstanceProcAddr"));
        return nullptr;
    }();
    return entry;
}

/// Success, or a failure that says what was tried.
inline Status outcome(std::string_view what, VkResult result) {
    if (result == VK_SUCCESS) return {};
    const std::string_view why = result == VK_ERROR_OUT_OF_DEVICE_MEMORY ? "the device has no memory left"
                                 : result == VK_ERROR_OUT_OF_HOST_MEMORY ? "no memory is left"
                                 : result == VK_ERROR_DEVICE_LOST        ? "the device was lost"
                                                                         : "";
    if (!why.empty()) return Status::failure(fmt::format("GPU: {}: {}", what, why));
    return Status::failure(
        fmt::format("GPU: {} failed (Vulkan's result {})", what, static_cast<int>(result)));
}

/// An instance and its functions.
class Instance {
  public:
    static std::optional<Instance> make(std::string& why) {
        const PFN_vkGetInstanceProcAddr entry = loader();
        if (!entry) {
            why = "no Vulkan loader (libvulkan.so.1) is installed";
            return std::nullopt;
        }
        const auto create = reinterpret_cast<PFN_vkCreateInstance>(entry(nullptr, "vkCreateInstance"));
        const VkApplicationInfo application{
            VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "graftal", 1, "graftal", 1, VK_API_VERSION_1_2};
        const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                        .pApplicationInfo = &application};
        VkInstance handle = VK_NULL_HANDLE;
        if (!create || create(&info, nullptr, &handle) != VK_SUCCESS) {
            why = "no driver of Vulkan 1.2 is installed";
            return std::nullopt;
        }
        vulkan::Instance instance;
        instance.handle = handle;
#define GRAFTAL_LOAD(name) instance.api.name = reinterpret_cast<PFN_##name>(entry(handle, #name));
        GRAFTAL_VULKAN_FUNCTIONS(GRAFTAL_LOAD)
#undef GRAFTAL_LOAD
        return instance;
    }
    Instance(Instance&& other) noexcept
        : api(other.api), handle(std::exchange(other.handle, VK_NULL_HANDLE)) {}
    Instance& operator=(Instance&&) = delete;
    ~Instance() {
        if (handle) api.vkDestroyInstance(handle, nullptr);
    }

    /// Devices of Vulkan 1.2, real ones first.
    std::vector<VkPhysicalDevice> devices() const {
        std::uint32_t count = 0;
        api.vkEnumeratePhysicalDevices(handle, &count, nullptr);
        std::vector<VkPhysicalDevice> devices(count);
        api.vkEnumeratePhysicalDevices(handle, &count, devices.data());
        devices.resize(count);
        std::erase_if(devices, [&](VkPhysicalDevice device) {
            return properties(device).apiVersion < VK_API_VERSION_1_2 || !queue_family(device);
        });
        std::stable_partition(devices.begin(), devices.end(),
                              [&](VkPhysicalDevice device) { return !info(device).is_processor; });
        return devices;
    }

    VkPhysicalDeviceProperties properties(VkPhysicalDevice device) const {
        VkPhysicalDeviceProperties properties{};
        api.vkGetPhysicalDeviceProperties(device, &properties);
        return properties;
    }

    VkPhysicalDeviceMemoryProperties memory(VkPhysicalDevice device) const {
        VkPhysicalDeviceMemoryProperties memory{};
        api.vkGetPhysicalDeviceMemoryProperties(device, &memory);
        return memory;
    }

    GpuInfo info(VkPhysicalDevice device) const {
        const VkPhysicalDeviceProperties facts = properties(device);
        GpuInfo info{facts.deviceName, facts.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU, 0,
                     facts.limits.maxStorageBufferRange, has_atomics_64(device)};
        const VkPhysicalDeviceMemoryProperties heaps = memory(device);
        for (std::uint32_t i = 0; i < heaps.memoryHeapCount; ++i)
            if (heaps.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
                info.memory_bytes = std::max<std::uint64_t>(info.memory_bytes, heaps.memoryHeaps[i].size);
        return info;
    }

    bool has_atomics_64(VkPhysicalDevice device) const {
        VkPhysicalDeviceVulkan12Features of_1_2 = features_1_2();
        VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                           .pNext = &of_1_2};
        api.vkGetPhysicalDeviceFeatures2(device, &features);
        return features.features.shaderInt64 && of_1_2.shaderBufferInt64Atomics;
    }

    static VkPhysicalDeviceVulkan12Features features_1_2() {
        return {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    }

    std::vector<VkQueueFamilyProperties> families(VkPhysicalDevice device) const {
        std::uint32_t count = 0;
        api.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
        std::vector<VkQueueFamilyProperties> families(count);
        api.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
        return families;
    }

    std::optional<std::uint32_t> queue_family(VkPhysicalDevice device) const {
        const std::vector<VkQueueFamilyProperties> families = this->families(device);
        for (std::uint32_t i = 0; i < families.size(); ++i)
            if (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) return i;
        return std::nullopt;
    }

    Api api;
    VkInstance handle = VK_NULL_HANDLE;

  private:
    Instance() = default;
};

} // namespace vulkan

} // namespace graftal
