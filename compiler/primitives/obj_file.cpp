#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "compiler/primitives/mesh_file.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/// The words of a line, one after the other.
class Words {
  public:
    explicit Words(std::string_view line) : rest_(line) {}

    std::string_view next() {
        while (!rest_.empty() && is_space(rest_.front()))
            rest_.remove_prefix(1);
        std::size_t end = 0;
        while (end < rest_.size() && !is_space(rest_[end]))
            ++end;
        const std::string_view word = rest_.substr(0, end);
        rest_.remove_prefix(end);
        return word;
    }

  private:
    std::string_view rest_;
};

bool parse(std::string_view word, double& number) {
    const auto [end, error] = read_double(word.data(), word.data() + word.size(), number);
    return error == std::errc() && end == word.data() + word.size();
}

class ObjReader {
  public:
    ObjReader(std::string_view text, std::string& fault) : rest_(text), fault_(fault) {}

    std::optional<MeshData> read() {
        while (!rest_.empty()) {
            const std::size_t end = std::min(rest_.find('\n'), rest_.size());
            const std::string_view line = rest_.substr(0, end);
            rest_.remove_prefix(std::min(end + 1, rest_.size()));
            ++line_;
            if (!read_line(line)) return std::nullopt;
        }
        if (!textured_) data_.uv.clear();
        if (smooth_ && !add_normals()) return std::nullopt;
        return std::move(data_);
    }

  private:
    /// The numbers of the vertex, its uv and its normal; the last two are -1 for none.
    using Corner = std::array<std::int64_t, 3>;

    bool fail(std::string_view what) {
        fault_ = fmt::format("line {}: {}", line_, what);
        return false;
    }

    bool read_line(std::string_view line) {
        Words words(line);
        const std::string_view keyword = words.next();
        if (keyword == "v") {
            Vec3 v;
            for (int i = 0; i < 3; ++i)
                if (!parse(words.next(), v[i])) return fail("a vertex has three numbers");
            for (int i = 0; i < 3; ++i)
                if (const std::string fault = fault_of_coordinate(v[i]); !fault.empty()) return fail(fault);
            if (data_.vertices.size() == most_mesh_vertices) return fail("there are too many vertices");
            data_.vertices.push_back(v);
        } else if (keyword == "vt") {
            std::array<double, 2> uv{};
            const std::string_view u = words.next(), v = words.next();
            if (!parse(u, uv[0]) || (!v.empty() && !parse(v, uv[1])))
                return fail("texture coordinates are one number or two");
            for (const double coordinate : uv)
                if (const std::string fault = fault_of_coordinate(coordinate); !fault.empty())
                    return fail("texture: " + fault);
            if (uv_.size() == 3 * most_mesh_triangles) return fail("there are too many texture coordinates");
            uv_.push_back(uv);
        } else if (keyword == "vn") {
            Vec3 normal;
            for (int i = 0; i < 3; ++i)
                if (!parse(words.next(), normal[i])) return fail("a normal has three numbers");
            if (normals_.size() == 3 * most_mesh_triangles) return fail("there are too many normals");
            normals_.push_back(normal);
        } else if (keyword == "f") {
            return read_face(words);
        }
        return true; // groups, materials and curves are left out
    }

    /// `v`, `v/t`, `v//n` or `v/t/n`, counted from 1, or backwards from -1.
    bool read_corner(std::string_view word, Corner& corner) {
        const std::size_t slash = std::min(word.find('/'), word.size());
        const std::size_t second = std::min(word.find('/', slash + 1), word.size());
        const std::string_view texture =
            slash < word.size() ? word.substr(slash + 1, second - slash - 1) : std::string_view();
        const std::string_view normal = second < word.size() ? word.substr(second + 1) : std::string_view();
        corner[1] = corner[2] = -1;
        return read_index(word.substr(0, slash), data_.vertices.size(), corner[0]) &&
               (texture.empty() || read_index(texture, uv_.size(), corner[1])) &&
               (normal.empty() || read_index(normal, normals_.size(), corner[2]));
    }

    static bool read_index(std::string_view word, std::size_t count, std::int64_t& index) {
        const auto number = parse_whole<std::int64_t>(word);
        if (!number) return false;
        index = *number < 0 ? static_cast<std::int64_t>(count) + *number : *number - 1;
        return index >= 0 && index < static_cast<std::int64_t>(count);
    }

    bool read_face(Words& words) {
        Corner first{}, last{}, corner{};
        int corners = 0;
        for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++corners) {
            if (!read_corner(word, corner)) return fail(fmt::format("'{}' names no vertex so far", word));
            if (corners >= 2 && !add({first, last, corner})) return false;
            (corners == 0 ? first : last) = corner;
        }
        return corners >= 3 || fail("a face has three corners or more");
    }

    bool add(const std::array<Corner, 3>& corners) {
        if (data_.triangles.size() == most_mesh_triangles) return fail("there are too many triangles");
        auto& triangle = data_.triangles.emplace_back();
        auto& uv = data_.uv.emplace_back();
        auto& normal = corner_normals_.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            triangle[k] = static_cast<std::uint32_t>(corners[k][0]);
            normal[k] = corners[k][2];
            smooth_ = smooth_ || corners[k][2] >= 0;
            if (corners[k][1] < 0) continue;
            uv[k] = uv_[static_cast<std::size_t>(corners[k][1])];
            textured_ = true;
        }
        return true;
    }

    /// Vertices with two normals become two vertices. A corner without one has that of its facet, (0, 0, 0)
    /// here, and a vertex of its own.
    bool add_normals() {
        std::vector<Vec3> vertices, normals;
        std::map<std::array<std::int64_t, 2>, std::uint32_t> number;
        for (std::size_t i = 0; i < data_.triangles.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                std::uint32_t& corner = data_.triangles[i][k];
                const std::int64_t normal = corner_normals_[i][k];
                const auto next = static_cast<std::uint32_t>(vertices.size());
                const auto [known, is_new] =
                    normal < 0 ? std::pair(number.end(), true) : number.try_emplace({corner, normal}, next);
                if (is_new) {
                    if (vertices.size() == most_mesh_vertices)
                        return fail("there are too many pairs of a vertex and a normal");
                    vertices.push_back(data_.vertices[corner]);
                    normals.push_back(normal < 0 ? Vec3(0.0) : normals_[static_cast<std::size_t>(normal)]);
                }
                corner = is_new ? next : known->second;
            }
        data_.vertices = std::move(vertices);
        data_.normals = std::move(normals);
        return true;
    }

    std::string_view rest_;
    std::string& fault_;
    std::size_t line_ = 0;
    MeshData data_;
    std::vector<Vec3> normals_;
    std::vector<std::array<std::int64_t, 3>> corner_normals_; ///< numbers in normals_, by triangle
    bool smooth_ = false;
    std::vector<std::array<double, 2>> uv_;
    bool textured_ = false;
};

} // namespace

std::optional<MeshData> read_obj(std::string_view text, std::string& fault) {
    return ObjReader(text, fault).read();
}

} // namespace graftal
