#include "runtime/points/ply_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "compiler/support/printable.h"
#include "runtime/system/file.h"

namespace graftal {

namespace {

constexpr std::uint64_t bytes_of_point = 15;

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string bytes_text(double bytes) {
    constexpr std::array<const char*, 6> units = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB"};
    std::size_t unit = 0;
    for (; bytes >= 1024 && unit + 1 < units.size(); ++unit)
        bytes /= 1024;
    return fmt::format("{:.3g} {}", bytes, units[unit]);
}

Status check_room(const std::string& path, std::uint64_t points) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::error_code error;
    const std::filesystem::space_info space = std::filesystem::space(folder.empty() ? "." : folder, error);
    if (error) return Status();
    const double needed = static_cast<double>(points) * bytes_of_point + 1024;
    if (needed <= static_cast<double>(space.available)) return Status();
    return Status::failure(fmt::format("no room for '{}': {} points take {}, but only {} is free", path,
                                       points, bytes_text(needed),
                                       bytes_text(static_cast<double>(space.available))));
}

std::string header(std::uint64_t points, const ImageMetadata& metadata) {
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    for (const std::string& line : {metadata.software, metadata.description})
        if (!line.empty()) text += "comment " + escaped(line, line.size()) + "\n";
    text += fmt::format("element vertex {}\n", points);
    for (const char* property : {"float x", "float y", "float z", "uchar red", "uchar green", "uchar blue"})
        text += fmt::format("property {}\n", property);
    return text + "end_header\n";
}

void append(float value, std::vector<char>& bytes) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<char>(bits >> shift & 0xff));
}

std::uint8_t byte_of(double linear) {
    // A table: the power of sRGB would take longer than the point.
    static const std::vector<std::uint8_t> table = [] {
        std::vector<std::uint8_t> levels;
        for (int i = 0; i <= 4095; ++i)
            levels.push_back(level8_of(srgb_encoded(static_cast<float>(i) / 4095)));
        return levels;
    }();
    const double level = linear > 0 ? std::min(linear, 1.0) * 4095 + 0.5 : 0;
    return table[static_cast<std::size_t>(level)];
}

} // namespace

CloudPoint cloud_point(Vec3 place, Rgb rgb) {
    CloudPoint point;
    for (int i = 0; i < 3; ++i) {
        point.place[i] = static_cast<float>(place[i]);
        point.rgb[i] = byte_of(rgb[i]);
    }
    return point;
}

Status write_ply(const std::string& path, const PointSource& source, const PointWork& work,
                 const ImageMetadata& metadata, const std::function<Rgb(const ChaosPoint&)>& coloured) {
    Status room = check_room(path, work.points);
    if (!room.ok()) return room;
    PendingFile pending(path);
    if (!pending.status().ok()) return pending.status();
    std::unique_ptr<std::FILE, Close> file(std::fopen(pending.temporary_path().c_str(), "wb"));
    int reason = file ? 0 : errno;
    const auto write = [&](const char* bytes, std::size_t count) {
        errno = 0;
        if (reason == 0 && std::fwrite(bytes, 1, count, file.get()) != count) reason = errno ? errno : EIO;
        return reason == 0;
    };
    const auto make = [&](std::span<const ChaosPoint> points, std::vector<char>& bytes) {
        for (const ChaosPoint& point : points) {
            const CloudPoint shown = cloud_point(point.place, coloured(point));
            for (const float coordinate : shown.place)
                append(coordinate, bytes);
            for (const std::uint8_t level : shown.rgb)
                bytes.push_back(static_cast<char>(level));
        }
    };
    const std::string head = header(work.points, metadata);
    const bool complete = reason == 0 && write(head.data(), head.size()) &&
                          write_points(source, work, make, [&](const std::vector<char>& bytes) {
                              return write(bytes.data(), bytes.size());
                          });
    if (file && std::fclose(file.release()) != 0 && reason == 0) reason = errno;
    if (reason != 0)
        return Status::failure(fmt::format("cannot write '{}': {}", path, std::strerror(reason)));
    return complete ? pending.commit() : Status::failure("interrupted");
}

} // namespace graftal
