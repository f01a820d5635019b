#pragma once

// Vulkan's functions, found at run time: no program depends on its library. Only this room includes this.

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan_core.h>

#define GRAFTAL_VULKAN_FUNCTIONS(FUNCTION)                                                                   \
    FUNCTION(vkDestroyInstance)                                                                              \
    FUNCTION(vkEnumeratePhysicalDevices)                                                                     \
    FUNCTION(vkGetPhysicalDeviceFeatures2)                                                                   \
    FUNCTION(vkGetPhysicalDeviceProperties)                                                                  \
    FUNCTION(vkGetPhysicalDeviceMemoryProperties)                                                            \
    FUNCTION(vkGetPhysicalDeviceQueueFamilyProperties)                                                       \
    FUNCTION(vkCreateDevice)                                                                                 \
    FUNCTION(vkDestroyDevice)                                                                                \
    FUNCTION(vkGetDeviceQueue)                                                                               \
    FUNCTION(vkCreateBuffer)                                                                                 \
    FUNCTION(vkDestroyBuffer)                                                                                \
    FUNCTION(vkGetBufferMemoryRequirements)                                                                  \
    FUNCTION(vkAllocateMemory)                                                                               \
    FUNCTION(vkFreeMemory)                                                                                   \
    FUNCTION(vkBindBufferMemory)                                                                             \
    FUNCTION(vkMapMemory)                                                                                    \
    FUNCTION(vkCreateShaderModule)                                                                           \
    FUNCTION(vkDestroyShaderModule)                                                                          \
    FUNCTION(vkCreateDescriptorSetLayout)                                                                    \
    FUNCTION(vkDestroyDescriptorSetLayout)                                                                   \
    FUNCTION(vkCreatePipelineLayout)                                                                         \
    FUNCTION(vkDestroyPipelineLayout)                                                                        \
    FUNCTION(vkCreateComputePipelines)                                                                       \
    FUNCTION(vkDestroyPipeline)                                                                              \
    FUNCTION(vkCreateDescriptorPool)                                                                         \
    FUNCTION(vkDestroyDescriptorPool)                                                                        \
    FUNCTION(vkAllocateDescriptorSets)                                                                       \
    FUNCTION(vkUpdateDescriptorSets)                                                                         \
    FUNCTION(vkCreateCommandPool)                                                                            \
    FUNCTION(vkDestroyCommandPool)                                                                           \
    FUNCTION(vkAllocateCommandBuffers)                                                                       \
    FUNCTION(vkBeginCommandBuffer)                                                                           \
    FUNCTION(vkEndCommandBuffer)                                                                             \
    FUNCTION(vkCmdBindPipeline)                                                                              \
    FUNCTION(vkCmdBindDescriptorSets)                                                                        \
    FUNCTION(vkCmdPushConstants)                                                                             \
    FUNCTION(vkCmdDispatch)                                                                                  \
    FUNCTION(vkCmdCopyBuffer)                                                                                \
    FUNCTION(vkCmdFillBuffer)                                                                                \
    FUNCTION(vkCmdPipelineBarrier)                                                                           \
    FUNCTION(vkCreateFence)                                                                                  \
    FUNCTION(vkDestroyFence)                                                                                 \
    FUNCTION(vkResetFences)                                                                                  \
    FUNCTION(vkWaitForFences)                                                                                \
    FUNCTION(vkCreateQueryPool)                                                                              \
    FUNCTION(vkDestroyQueryPool)                                                                             \
    FUNCTION(vkCmdResetQueryPool)                                                                            \
    FUNCTION(vkCmdWriteTimestamp)                                                                            \
    FUNCTION(vkGetQueryPoolResults)                                                                          \
    FUNCTION(vkQueueSubmit)                                                                                  \
    FUNCTION(vkDeviceWaitIdle)
