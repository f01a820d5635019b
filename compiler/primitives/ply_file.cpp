#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "compiler/primitives/mesh_file.h"
#include "compiler/support/number.h"

// PLY as G. Turk has it ("The PLY Polygon File Format", 1994): a header of elements and their properties,
// then the elements, as text or binary.

namespace graftal {

namespace {

struct Type {
    std::size_t bytes = 0;
    bool is_float = false, is_signed = false;
};

std::optional<Type> type_named(std::string_view name) {
    if (name == "char" || name == "int8") return Type{1, false, true};
    if (name == "uchar" || name == "uint8") return Type{1, false, false};
    if (name == "short" || name == "int16") return Type{2, false, true};
    if (name == "ushort" || name == "uint16") return Type{2, false, false};
    if (name == "int" || name == "int32") return Type{4, false, true};
    if (name == "uint" || name == "uint32") return Type{4, false, false};
    if (name == "float" || name == "float32") return Type{4, true, true};
    if (name == "double" || name == "float64") return Type{8, true, true};
    return std::nullopt;
}

struct Property {
    std::string name;
    Type type;
    std::optional<Type> count; ///< of a list
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

class PlyReader {
  public:
    PlyReader(std::string_view bytes, std::string& fault) : all_(bytes), rest_(bytes), fault_(fault) {}

    std::optional<MeshData> read() {
        if (!read_header() || !check_counts()) return std::nullopt;
        in_header_ = false;
        for (const Element& element : elements_)
            for (std::uint64_t i = 0; i < element.count; ++i)
                if (!read_element(element)) return std::nullopt;
        if (!textured_) data_.uv.clear();
        if (!smooth_) data_.normals.clear();
        return std::move(data_);
    }

  private:
    bool fail(std::string_view what) {
        fault_ = in_header_ ? fmt::format("line {}: {}", line_, what)
                            : fmt::format("byte {}: {}", all_.size() - rest_.size() + 1, what);
        return false;
    }

    std::string_view line() {
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        std::string_view text = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        if (text.ends_with('\r')) text.remove_suffix(1);
        ++line_;
        return text;
    }

    static std::vector<std::string_view> words_of(std::string_view text) {
        std::vector<std::string_view> words;
        while (!text.empty() && words.size() < 6) {
            const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
            text.remove_prefix(begin);
            const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
            if (end > 0) words.push_back(text.substr(0, end));
            text.remove_prefix(end);
        }
        return words;
    }

    bool read_header() {
        constexpr int most_lines = 1000;
        if (line() != "ply") return fail("this is no PLY file");
        for (int i = 0; i < most_lines && !rest_.empty(); ++i) {
            const std::vector<std::string_view> words = words_of(line());
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
            if (words[0] == "end_header") return has_format_ || fail("the PLY header names no format");
            if (!read_header_line(words)) return false;
        }
        return fail("the PLY header does not end");
    }

    bool read_header_line(const std::vector<std::string_view>& words) {
        if (words[0] == "format" && words.size() >= 2) {
            has_format_ = true;
            text_ = words[1] == "ascii";
            const bool little = words[1] == "binary_little_endian", big = words[1] == "binary_big_endian";
            swapped_ = std::endian::native == std::endian::little ? big : little;
            return text_ || little || big || fail(fmt::format("'{}' is no format of PLY files", words[1]));
        }
        if (words[0] == "element" && words.size() == 3) {
            Element& element = elements_.emplace_back();
            element.name = words[1];
            const auto count = parse_whole<std::uint64_t>(words[2]);
            element.count = count.value_or(0);
            return count || fail(fmt::format("'{}' is no number of elements", words[2]));
        }
        const bool list = words.size() == 5 && words[1] == "list";
        if (words[0] != "property" || elements_.empty() || (!list && words.size() != 3))
            return fail(fmt::format("'{}' makes no sense in a PLY header", words[0]));
        Property property;
        property.name = words.back();
        const std::optional<Type> type = type_named(words[words.size() - 2]);
        if (list) property.count = type_named(words[2]);
        if (!type || (list && (!property.count || property.count->is_float)))
            return fail(fmt::format("property '{}' has no type that PLY files have", property.name));
        property.type = *type;
        elements_.back().properties.push_back(std::move(property));
        return true;
    }

    /// Checks the counts before anything is read: each element takes a byte at least.
    bool check_counts() {
        std::uint64_t sum = 0, vertices = 0, faces = 0; // a header may name an element again
        for (const Element& element : elements_) {
            if (element.properties.empty() && element.count > 0)
                return fail(fmt::format("element '{}' has no properties", element.name));
            if (element.count > rest_.size() || (sum += element.count) > rest_.size())
                return fail("the file is shorter than its header says");
            if (element.name == "vertex" && (vertices += element.count) > most_mesh_vertices)
                return fail(
                    fmt::format("there are {} vertices, and {} are the most", vertices, most_mesh_vertices));
            if (element.name == "face" && (faces += element.count) > most_mesh_triangles)
                return fail(
                    fmt::format("there are {} faces, and {} are the most", faces, most_mesh_triangles));
        }
        return true;
    }

    bool read_number(const Type& type, double& number) {
        if (text_) {
            const std::size_t begin = rest_.find_first_not_of(" \t\r\n");
            if (begin == std::string_view::npos) return fail("the file ends too early");
            rest_.remove_prefix(begin);
            const auto [end, error] = read_double(rest_.data(), rest_.data() + rest_.size(), number);
            if (error != std::errc()) return fail("something in the file is no number");
            rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
            return true;
        }
        if (rest_.size() < type.bytes) return fail("the file ends too early");
        std::array<char, 8> bytes{};
        std::memcpy(bytes.data(), rest_.data(), type.bytes);
        rest_.remove_prefix(type.bytes);
        if (swapped_) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(type.bytes));
        number = as_number(type, bytes);
        return true;
    }

    template<typename T> static double as(const std::array<char, 8>& bytes) {
        T value;
        std::memcpy(&value, bytes.data(), sizeof(value));
        return static_cast<double>(value);
    }

    static double as_number(const Type& type, const std::array<char, 8>& bytes) {
        if (type.is_float) return type.bytes == 4 ? as<float>(bytes) : as<double>(bytes);
        if (type.bytes == 1) return type.is_signed ? as<std::int8_t>(bytes) : as<std::uint8_t>(bytes);
        if (type.bytes == 2) return type.is_signed ? as<std::int16_t>(bytes) : as<std::uint16_t>(bytes);
        return type.is_signed ? as<std::int32_t>(bytes) : as<std::uint32_t>(bytes);
    }

    bool read_element(const Element& element) {
        const bool vertex = element.name == "vertex", face = element.name == "face";
        Vec3 point(0.0), normal(0.0);
        std::array<double, 2> uv{};
        bool has_uv = false;
        for (const Property& property : element.properties) {
            if (property.count) {
                const bool corners = face && property.name.starts_with("vertex_ind");
                if (!read_list(property, corners)) return false;
                continue;
            }
            double number = 0;
            if (!read_number(property.type, number)) return false;
            const std::string& name = property.name;
            if (name == "x" || name == "y" || name == "z") point[name[0] - 'x'] = number;
            const bool along = name == "nx" || name == "ny" || name == "nz";
            if (along) normal[name[1] - 'x'] = number;
            smooth_ = smooth_ || (vertex && along);
            const bool u = name == "u" || name == "s" || name == "texture_u",
                       v = name == "v" || name == "t" || name == "texture_v";
            if (u || v) uv[v ? 1 : 0] = number;
            const bool place = vertex && (u || v || name == "x" || name == "y" || name == "z");
            if (const std::string fault = place ? fault_of_coordinate(number) : ""; !fault.empty())
                return fail(fault);
            has_uv = has_uv || u || v;
        }
        if (!vertex) return true;
        data_.vertices.push_back(point);
        data_.normals.push_back(normal);
        uv_.push_back(uv);
        textured_ = textured_ || has_uv;
        return true;
    }

    /// A list of corners becomes a fan.
    bool read_list(const Property& property, bool corners) {
        double count = 0;
        if (!read_number(*property.count, count)) return false;
        if (!(count >= 0 && count <= static_cast<double>(rest_.size())))
            return fail("a list is longer than the file");
        std::uint32_t first = 0, last = 0;
        for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) {
            double number = 0;
            if (!read_number(property.type, number)) return false;
            if (!corners) continue;
            if (!(number >= 0 && number < static_cast<double>(data_.vertices.size())))
                return fail(
                    fmt::format("a face names vertex {}, and there are {}", number, data_.vertices.size()));
            const auto corner = static_cast<std::uint32_t>(number);
            if (i >= 2 && !add({first, last, corner})) return false;
            (i == 0 ? first : last) = corner;
        }
        return true;
    }

    bool add(const std::array<std::uint32_t, 3>& corners) {
        if (data_.triangles.size() == most_mesh_triangles) return fail("there are too many triangles");
        data_.triangles.push_back(corners);
        auto& uv = data_.uv.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
            uv[k] = uv_[corners[k]];
        return true;
    }

    std::string_view all_, rest_;
    std::string& fault_;
    bool in_header_ = true;
    std::size_t line_ = 0;
    bool has_format_ = false, text_ = false, swapped_ = false, textured_ = false, smooth_ = false;
    std::vector<Element> elements_;
    MeshData data_;
    std::vector<std::array<double, 2>> uv_; ///< by vertex
};

} // namespace

std::optional<MeshData> read_ply(std::string_view bytes, std::string& fault) {
    return PlyReader(bytes, fault).read();
}

} // namespace graftal
