#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "compiler/primitives/mesh_file.h"
#include "compiler/support/id_table.h"
#include "compiler/support/number.h"
#include "compiler/support/small_letters.h"

// STL as 3D Systems has it ("StereoLithography Interface Specification", 1989): facets of three corners each,
// as text or binary. Two facets that share a corner both give its place, so equal places become one vertex.

namespace graftal {

namespace {

constexpr std::size_t stl_head = 84;  ///< bytes: 80 of anything, and the number of facets
constexpr std::size_t stl_facet = 50; ///< bytes: a normal and three corners, three numbers each, and two more

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t i = 4; i-- > 0;)
        word = word << 8 | static_cast<unsigned char>(bytes[at + i]);
    return word;
}

class StlReader {
  public:
    StlReader(std::string_view bytes, std::string& fault) : all_(bytes), rest_(bytes), fault_(fault) {}

    std::optional<MeshData> read() {
        const bool is_read = is_binary_stl(all_) ? read_binary() : read_text();
        return is_read ? std::optional(std::move(data_)) : std::nullopt;
    }

  private:
    bool read_binary() {
        const std::uint32_t count = little_endian(all_, stl_head - 4);
        if (count > most_mesh_triangles) {
            fault_ = fmt::format("there are {} triangles, and {} are the most", count, most_mesh_triangles);
            return false;
        }
        for (std::size_t begin = stl_head; begin < all_.size(); begin += stl_facet)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t at = begin + 12 * (k + 1);
                Vec3 place;
                for (int i = 0; i < 3; ++i)
                    place[i] =
                        std::bit_cast<float>(little_endian(all_, at + 4 * static_cast<std::size_t>(i)));
                std::string what;
                if (!add_corner(place, k, what)) {
                    fault_ = fmt::format("byte {}: {}", at + 1, what);
                    return false;
                }
            }
        return true;
    }

    bool fail(std::string_view what) {
        fault_ = fmt::format("line {}: {}", line_, what);
        return false;
    }

    std::string_view next() {
        const std::size_t begin = std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size());
        line_ += static_cast<std::size_t>(std::ranges::count(rest_.substr(0, begin), '\n'));
        rest_.remove_prefix(begin);
        const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
        rest_.remove_prefix(word.size());
        return word;
    }

    bool read_text() {
        std::size_t corners = 0;
        bool in_facet = false;
        for (std::string_view word = next(); !word.empty(); word = next()) {
            const std::string keyword = in_small_letters(word);
            if (corners != (keyword == "endloop" ? 3u : 0u) && (keyword != "vertex" || corners == 3))
                return fail("a facet has three corners, and then 'endloop'");
            in_facet = keyword != "solid" && keyword != "endsolid" && keyword != "endfacet";
            if (keyword == "solid" || keyword == "endsolid") {
                rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size())); // the name, of any words
            } else if (keyword == "vertex") {
                if (!read_vertex(corners++)) return false;
            } else if (keyword == "endloop") {
                corners = 0;
            } else if (keyword == "normal") {
                for (int i = 0; i < 3; ++i) // the corners tell it, too
                    next();
            } else if (keyword != "facet" && keyword != "outer" && keyword != "loop" &&
                       keyword != "endfacet") {
                return fail(fmt::format("'{}' makes no sense in an STL file", word.substr(0, 40)));
            }
        }
        return !in_facet || fail("the file ends within a facet");
    }

    bool read_vertex(std::size_t corner) {
        Vec3 place;
        for (int i = 0; i < 3; ++i) {
            const std::string_view word = next();
            const auto [end, error] = read_double(word.data(), word.data() + word.size(), place[i]);
            if (error != std::errc() || end != word.data() + word.size())
                return fail("a vertex has three numbers");
        }
        std::string what;
        return add_corner(place, corner, what) || fail(what);
    }

    /// The first corner begins a triangle.
    bool add_corner(Vec3 place, std::size_t corner, std::string& what) {
        std::uint64_t hash = 0;
        for (int i = 0; i < 3; ++i) {
            what = fault_of_coordinate(place[i]);
            if (!what.empty()) return false;
            hash = mixed(hash, std::bit_cast<std::uint64_t>(place[i] += 0.0)); // no -0
        }
        const auto next = static_cast<std::uint32_t>(data_.vertices.size());
        const std::uint32_t id = places_.find_or_add(
            hash, next, [&](std::uint32_t other) { return data_.vertices[other] == place; });
        if (id == next) data_.vertices.push_back(place);
        if (corner == 0) data_.triangles.emplace_back();
        data_.triangles.back()[corner] = id;
        if (data_.vertices.size() > most_mesh_vertices) what = "there are too many vertices";
        if (data_.triangles.size() > most_mesh_triangles) what = "there are too many triangles";
        return what.empty();
    }

    std::string_view all_, rest_;
    std::string& fault_;
    std::size_t line_ = 1;
    MeshData data_;
    IdTable places_; ///< of the vertices
};

} // namespace

std::uint64_t binary_stl_size(std::string_view bytes) {
    return bytes.size() < stl_head ? stl_head
                                   : stl_head + stl_facet * std::uint64_t{little_endian(bytes, stl_head - 4)};
}

bool is_binary_stl(std::string_view bytes) {
    return binary_stl_size(bytes) == bytes.size();
}

std::optional<MeshData> read_stl(std::string_view bytes, std::string& fault) {
    return StlReader(bytes, fault).read();
}

} // namespace graftal
