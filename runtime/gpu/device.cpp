#include "runtime/gpu/device.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "runtime/gpu/vulkan_instance.h"

namespace graftal {

using vulkan::Api, vulkan::outcome;

std::vector<GpuInfo> gpu_devices(std::string* why) {
    std::string reason = "Vulkan has no device here";
    std::vector<GpuInfo> found;
    if (const std::optional<vulkan::Instance> instance = vulkan::Instance::make(reason))
        for (const VkPhysicalDevice device : instance->devices())
            found.push_back(instance->info(device));
    if (why && found.empty()) *why = reason;
    return found;
}

struct Gpu::Buffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
};

struct Gpu::Parts {
    /// All that a kernel is made of.
    struct Kernel {
        const std::uint32_t* text = nullptr;
        std::size_t buffers = 0;
        std::uint32_t push_bytes = 0;
        std::vector<std::uint32_t> constants;
        std::size_t uniform = no_binding;
        bool operator==(const Kernel&) const = default;
    };

    explicit Parts(vulkan::Instance made) : instance(std::move(made)) {}

    ~Parts() {
        const Api& api = instance.api;
        if (!device) return;
        if (is_stuck) { // to wait for it could take forever
            instance.handle = VK_NULL_HANDLE;
            return;
        }
        unload();
        free(stage);
        if (fence) api.vkDestroyFence(device, fence, nullptr);
        if (pool) api.vkDestroyCommandPool(device, pool, nullptr);
        if (clock) api.vkDestroyQueryPool(device, clock, nullptr);
        api.vkDestroyDevice(device, nullptr);
    }

    void free_buffers() {
        instance.api.vkDeviceWaitIdle(device);
        for (Buffer& buffer : buffers)
            free(buffer);
        buffers.clear();
    }

    /// Frees the kernel and its buffers.
    void unload() {
        const Api& api = instance.api;
        free_buffers();
        kernel = {};
        // Vulkan destroys null handles, too.
        api.vkDestroyDescriptorPool(device, std::exchange(sets, VK_NULL_HANDLE), nullptr);
        api.vkDestroyPipeline(device, std::exchange(pipeline, VK_NULL_HANDLE), nullptr);
        api.vkDestroyPipelineLayout(device, std::exchange(layout, VK_NULL_HANDLE), nullptr);
        api.vkDestroyDescriptorSetLayout(device, std::exchange(set_layout, VK_NULL_HANDLE), nullptr);
    }

    Status open(VkPhysicalDevice physical) {
        const Api& api = instance.api;
        memory = instance.memory(physical);
        const GpuInfo facts = instance.info(physical);
        if (facts.is_processor) longest_wait_ns *= 10; // others may use it, too
        most_buffer_bytes = facts.most_buffer_bytes;
        const std::uint32_t family = *instance.queue_family(physical);
        const float priority = 1;
        const VkDeviceQueueCreateInfo queues{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                             .queueFamilyIndex = family,
                                             .queueCount = 1,
                                             .pQueuePriorities = &priority};
        VkPhysicalDeviceVulkan12Features of_1_2 = vulkan::Instance::features_1_2();
        VkPhysicalDeviceFeatures features{};
        features.shaderInt64 = of_1_2.shaderBufferInt64Atomics = facts.atomics_64;
        const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .pNext = &of_1_2,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queues,
                                      .pEnabledFeatures = &features};
        Status status = outcome("opening the device", api.vkCreateDevice(physical, &info, nullptr, &device));
        if (!status.ok()) return status;
        api.vkGetDeviceQueue(device, family, 0, &queue);
        const VkCommandPoolCreateInfo of_pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                              .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                              .queueFamilyIndex = family};
        status = outcome("making a command pool", api.vkCreateCommandPool(device, &of_pool, nullptr, &pool));
        if (!status.ok()) return status;
        const VkCommandBufferAllocateInfo of_commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                      .commandPool = pool,
                                                      .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                      .commandBufferCount = 1};
        status =
            outcome("making a command buffer", api.vkAllocateCommandBuffers(device, &of_commands, &commands));
        if (!status.ok()) return status;
        const VkFenceCreateInfo of_fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        status = outcome("making a fence", api.vkCreateFence(device, &of_fence, nullptr, &fence));
        if (!status.ok()) return status;
        if (instance.families(physical)[family].timestampValidBits >= 64) {
            const VkQueryPoolCreateInfo of_clock{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                                 .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                                 .queryCount = 2};
            status = outcome("making a clock", api.vkCreateQueryPool(device, &of_clock, nullptr, &clock));
            if (!status.ok()) return status;
            tick_seconds = 1e-9 * instance.properties(physical).limits.timestampPeriod;
        }
        return make_buffer(stage_bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           true, stage);
    }

    /// `by_host`: where the host reads and writes; else where the device does so fastest.
    Status make_buffer(VkDeviceSize size, VkBufferUsageFlags usage, bool by_host, Buffer& made) {
        const Api& api = instance.api;
        const VkBufferCreateInfo info{
            .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
        Status status = outcome("making a buffer", api.vkCreateBuffer(device, &info, nullptr, &made.buffer));
        if (!status.ok()) return status;
        VkMemoryRequirements needs{};
        api.vkGetBufferMemoryRequirements(device, made.buffer, &needs);
        constexpr VkMemoryPropertyFlags coherent =
            VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        const std::array<VkMemoryPropertyFlags, 2> wanted = {
            by_host ? coherent | VK_MEMORY_PROPERTY_HOST_CACHED_BIT
                    : VkMemoryPropertyFlags{VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT},
            by_host ? coherent : VkMemoryPropertyFlags{0}};
        VkResult result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
        for (const VkMemoryPropertyFlags flags : wanted)
            for (std::uint32_t type = 0; type < memory.memoryTypeCount && result != VK_SUCCESS; ++type) {
                if (!(needs.memoryTypeBits >> type & 1) ||
                    (memory.memoryTypes[type].propertyFlags & flags) != flags)
                    continue;
                const VkMemoryAllocateInfo of_memory{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                                     .allocationSize = needs.size,
                                                     .memoryTypeIndex = type};
                result = api.vkAllocateMemory(device, &of_memory, nullptr, &made.memory);
            }
        status = outcome(fmt::format("a buffer of {} bytes", size), result);
        if (!status.ok()) return status;
        status = outcome("binding memory", api.vkBindBufferMemory(device, made.buffer, made.memory, 0));
        if (!status.ok() || !by_host) return status;
        void* mapped = nullptr;
        status =
            outcome("mapping memory", api.vkMapMemory(device, made.memory, 0, VK_WHOLE_SIZE, 0, &mapped));
        staged = static_cast<std::byte*>(mapped);
        return status;
    }

    void free(Buffer& buffer) {
        const Api& api = instance.api;
        if (buffer.buffer) api.vkDestroyBuffer(device, buffer.buffer, nullptr);
        if (buffer.memory) api.vkFreeMemory(device, buffer.memory, nullptr);
        buffer = {};
    }

    /// Records commands by `record`, submits them and waits.
    template<typename Record> Status submit(const Record& record) {
        const Api& api = instance.api;
        const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                             .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
        VkResult result = api.vkBeginCommandBuffer(commands, &begin);
        if (result == VK_SUCCESS) {
            record();
            result = api.vkEndCommandBuffer(commands);
        }
        const VkSubmitInfo info{
            .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
        if (result == VK_SUCCESS) result = api.vkResetFences(device, 1, &fence);
        if (result == VK_SUCCESS) result = api.vkQueueSubmit(queue, 1, &info, fence);
        if (result == VK_SUCCESS) result = api.vkWaitForFences(device, 1, &fence, VK_TRUE, longest_wait_ns);
        is_stuck = result == VK_TIMEOUT;
        if (is_stuck) return Status::failure("GPU: the device takes too long for a part of the picture");
        return outcome("running the kernel", result);
    }

    /// Lets the next command read what those before it write.
    void wait_for_writes() {
        const VkMemoryBarrier barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                      .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                                      .dstAccessMask =
                                          VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
        instance.api.vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                          VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0,
                                          1, &barrier, 0, nullptr, 0, nullptr);
    }

    Status clear(Buffer& buffer) {
        return submit([&] { instance.api.vkCmdFillBuffer(commands, buffer.buffer, 0, VK_WHOLE_SIZE, 0); });
    }

    /// Copies between the stage and a place in a buffer.
    Status copy(Buffer& buffer, VkDeviceSize at, VkDeviceSize bytes, bool to_device) {
        return submit([&] {
            wait_for_writes();
            const VkBufferCopy region{to_device ? 0 : at, to_device ? at : 0, bytes};
            instance.api.vkCmdCopyBuffer(commands, to_device ? stage.buffer : buffer.buffer,
                                         to_device ? buffer.buffer : stage.buffer, 1, &region);
            wait_for_writes();
        });
    }

    VkDescriptorType kind_of(std::size_t binding) const {
        return binding == kernel.uniform ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                                         : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    }

    static constexpr VkDeviceSize stage_bytes = 16 << 20;
    std::uint64_t longest_wait_ns = 60'000'000'000;

    vulkan::Instance instance;
    VkPhysicalDeviceMemoryProperties memory{};
    VkDeviceSize most_buffer_bytes = 0;
    bool is_stuck = false; ///< it has not come to the end of a kernel
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    VkQueryPool clock = VK_NULL_HANDLE; ///< null where the device has none
    double tick_seconds = 0;
    Buffer stage;
    std::byte* staged = nullptr;
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkDescriptorPool sets = VK_NULL_HANDLE;
    VkDescriptorSet set = VK_NULL_HANDLE;
    std::vector<Buffer> buffers;
    Kernel kernel; ///< that is loaded; none: its text is null
};

Gpu::Gpu(std::unique_ptr<Parts> parts, GpuInfo info) : parts_(std::move(parts)), info_(std::move(info)) {}
Gpu::~Gpu() = default;

std::unique_ptr<Gpu> Gpu::open(std::size_t number, Status& status) {
    std::string why;
    std::optional<vulkan::Instance> instance = vulkan::Instance::make(why);
    if (!instance) {
        status = Status::failure("GPU: " + why);
        return nullptr;
    }
    const std::vector<VkPhysicalDevice> devices = instance->devices();
    if (number >= devices.size()) {
        status = Status::failure(fmt::format("GPU: there is no device number {}", number));
        return nullptr;
    }
    GpuInfo info = instance->info(devices[number]);
    auto parts = std::make_unique<Parts>(std::move(*instance));
    status = parts->open(devices[number]);
    if (!status.ok()) return nullptr;
    return std::unique_ptr<Gpu>(new Gpu(std::move(parts), std::move(info)));
}

Status Gpu::load(std::span<const std::uint32_t> spirv, std::size_t buffers, std::uint32_t push_bytes,
                 std::span<const std::uint32_t> constants, std::size_t uniform) {
    Parts::Kernel kernel{spirv.data(), buffers, push_bytes, {constants.begin(), constants.end()}, uniform};
    if (parts_->kernel == kernel) {
        parts_->free_buffers();
        return {};
    }
    parts_->unload();
    parts_->kernel = std::move(kernel);
    const Api& api = parts_->instance.api;
    const VkDevice device = parts_->device;
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (std::size_t i = 0; i < buffers; ++i)
        bindings.push_back(
            {static_cast<std::uint32_t>(i), parts_->kind_of(i), 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    const VkDescriptorSetLayoutCreateInfo of_set{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                 .bindingCount = static_cast<std::uint32_t>(bindings.size()),
                                                 .pBindings = bindings.data()};
    VkResult result = api.vkCreateDescriptorSetLayout(device, &of_set, nullptr, &parts_->set_layout);
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, push_bytes};
    const VkPipelineLayoutCreateInfo of_layout{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 1,
                                               .pSetLayouts = &parts_->set_layout,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &range};
    if (result == VK_SUCCESS)
        result = api.vkCreatePipelineLayout(device, &of_layout, nullptr, &parts_->layout);
    const VkShaderModuleCreateInfo of_module{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                             .codeSize = spirv.size_bytes(),
                                             .pCode = spirv.data()};
    VkShaderModule module = VK_NULL_HANDLE;
    if (result == VK_SUCCESS) result = api.vkCreateShaderModule(device, &of_module, nullptr, &module);
    std::vector<VkSpecializationMapEntry> entries;
    for (std::uint32_t i = 0; i < constants.size(); ++i)
        entries.push_back({i, 4 * i, 4});
    const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                              constants.size_bytes(), constants.data()};
    const VkComputePipelineCreateInfo of_pipeline{
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main",
                  .pSpecializationInfo = &specialization},
        .layout = parts_->layout};
    if (result == VK_SUCCESS)
        result =
            api.vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &of_pipeline, nullptr, &parts_->pipeline);
    if (module) api.vkDestroyShaderModule(device, module, nullptr);
    const std::array<VkDescriptorPoolSize, 2> sizes = {
        {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, static_cast<std::uint32_t>(buffers)},
         {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1}}};
    const VkDescriptorPoolCreateInfo of_pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = sizes.size(),
                                             .pPoolSizes = sizes.data()};
    if (result == VK_SUCCESS) result = api.vkCreateDescriptorPool(device, &of_pool, nullptr, &parts_->sets);
    const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               .descriptorPool = parts_->sets,
                                               .descriptorSetCount = 1,
                                               .pSetLayouts = &parts_->set_layout};
    if (result == VK_SUCCESS) result = api.vkAllocateDescriptorSets(device, &allocate, &parts_->set);
    if (result != VK_SUCCESS) parts_->kernel = {};
    return outcome("making the kernel", result);
}

Status Gpu::add_buffer(std::span<const std::byte> bytes, std::size_t size) {
    Parts& parts = *parts_;
    const Api& api = parts.instance.api;
    constexpr VkDeviceSize least = 16;
    const VkDeviceSize whole = (std::max<VkDeviceSize>({bytes.size(), size, least}) + 15) / 16 * 16;
    if (whole > parts.most_buffer_bytes)
        return Status::failure(fmt::format("GPU: the device takes no buffer of {} bytes", whole));
    Buffer& buffer = parts.buffers.emplace_back();
    constexpr VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                         VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                                         VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (Status status = parts.make_buffer(whole, usage, false, buffer); !status.ok()) return status;
    if (bytes.size() < whole)
        if (Status status = parts.clear(buffer); !status.ok()) return status;
    for (std::size_t at = 0; at < bytes.size(); at += Parts::stage_bytes) {
        const std::size_t piece = std::min<std::size_t>(bytes.size() - at, Parts::stage_bytes);
        std::memcpy(parts.staged, bytes.data() + at, piece);
        if (Status status = parts.copy(buffer, at, piece, true); !status.ok()) return status;
    }
    const VkDescriptorBufferInfo info{buffer.buffer, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     .dstSet = parts.set,
                                     .dstBinding = static_cast<std::uint32_t>(parts.buffers.size() - 1),
                                     .descriptorCount = 1,
                                     .descriptorType = parts.kind_of(parts.buffers.size() - 1),
                                     .pBufferInfo = &info};
    api.vkUpdateDescriptorSets(parts.device, 1, &write, 0, nullptr);
    return {};
}

Status Gpu::clear(std::size_t binding) {
    return parts_->clear(parts_->buffers[binding]);
}

Status Gpu::read(std::size_t binding, std::span<std::byte> bytes, std::size_t from) {
    Parts& parts = *parts_;
    for (std::size_t at = 0; at < bytes.size(); at += Parts::stage_bytes) {
        const std::size_t piece = std::min<std::size_t>(bytes.size() - at, Parts::stage_bytes);
        if (Status status = parts.copy(parts.buffers[binding], from + at, piece, false); !status.ok())
            return status;
        std::memcpy(bytes.data() + at, parts.staged, piece);
    }
    return {};
}

Status Gpu::run(std::span<const std::byte> push, std::uint32_t groups, double& seconds) {
    Parts& parts = *parts_;
    const Api& api = parts.instance.api;
    const auto begin = std::chrono::steady_clock::now();
    const auto stamp = [&](std::uint32_t number) {
        if (parts.clock)
            api.vkCmdWriteTimestamp(parts.commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, parts.clock,
                                    number);
    };
    Status status = parts.submit([&] {
        parts.wait_for_writes();
        if (parts.clock) api.vkCmdResetQueryPool(parts.commands, parts.clock, 0, 2);
        stamp(0);
        api.vkCmdBindPipeline(parts.commands, VK_PIPELINE_BIND_POINT_COMPUTE, parts.pipeline);
        api.vkCmdBindDescriptorSets(parts.commands, VK_PIPELINE_BIND_POINT_COMPUTE, parts.layout, 0, 1,
                                    &parts.set, 0, nullptr);
        api.vkCmdPushConstants(parts.commands, parts.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                               static_cast<std::uint32_t>(push.size()), push.data());
        api.vkCmdDispatch(parts.commands, groups, 1, 1);
        stamp(1);
    });
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    std::array<std::uint64_t, 2> ticks{};
    if (status.ok() && parts.clock &&
        api.vkGetQueryPoolResults(parts.device, parts.clock, 0, 2, sizeof ticks, ticks.data(),
                                  sizeof ticks[0], VK_QUERY_RESULT_64_BIT) == VK_SUCCESS)
        seconds = static_cast<double>(ticks[1] - ticks[0]) * parts.tick_seconds;
    return status;
}

} // namespace graftal
