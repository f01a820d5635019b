#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "compiler/support/status.h"

namespace graftal {

/// A device that Vulkan 1.2 has on this machine.
struct GpuInfo {
    std::string name;
    bool is_processor = false; ///< it is the machine's processors, by software
    std::uint64_t memory_bytes = 0;
    std::uint64_t most_buffer_bytes = 0;
    bool atomics_64 = false; ///< kernels may add to whole numbers of 64 bits that several threads share
};

/// The devices, real ones first. Empty where there is no loader, no driver or no device; `why` then says
/// which.
std::vector<GpuInfo> gpu_devices(std::string* why = nullptr);

/// One device, its buffers and one kernel. For one thread. Every failure is a Status: of memory, of the
/// driver, or of a device that was lost; after that all fails.
class Gpu {
  public:
    struct Buffer;

    /// Opens the device with this number of gpu_devices(); null, and a status, where that fails.
    static std::unique_ptr<Gpu> open(std::size_t number, Status& status);
    ~Gpu();
    Gpu(const Gpu&) = delete;
    Gpu& operator=(const Gpu&) = delete;

    /// Makes a kernel of a SPIR-V text whose entry is main(), with `buffers` storage buffers at the bindings
    /// from 0 on, `push_bytes` of push constants, and values of its constants. It takes the place of the
    /// one before, whose buffers go; the same one is not made again. The text outlives the device. `uniform`:
    /// the binding of a buffer of at most 16 KiB that is read alike by all, if there is one.
    static constexpr std::size_t no_binding = SIZE_MAX;
    Status load(std::span<const std::uint32_t> spirv, std::size_t buffers, std::uint32_t push_bytes,
                std::span<const std::uint32_t> constants, std::size_t uniform = no_binding);

    /// A new buffer at the next binding, of zeros beyond `bytes`; at least one word.
    Status add_buffer(std::span<const std::byte> bytes, std::size_t size = 0);
    /// Fills a buffer with zeros.
    Status clear(std::size_t binding);
    /// Reads a buffer back, from that byte on.
    Status read(std::size_t binding, std::span<std::byte> bytes, std::size_t from = 0);

    /// Runs the kernel in that many groups, and waits for it. `seconds`: that it took, by the device's clock
    /// where it has one.
    Status run(std::span<const std::byte> push, std::uint32_t groups, double& seconds);

    const GpuInfo& info() const { return info_; }

  private:
    struct Parts;
    explicit Gpu(std::unique_ptr<Parts> parts, GpuInfo info);

    std::unique_ptr<Parts> parts_;
    GpuInfo info_;
};

} // namespace graftal
