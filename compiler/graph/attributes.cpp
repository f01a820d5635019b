#include "compiler/graph/attributes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "compiler/support/number.h"

namespace graftal {

namespace attribute_rows {

constexpr Attribute place = {
    .put =
        [](const Instance& instance, AttributeWords& words) {
            const Affine& a = instance.parent_from_child;
            for (int column = 0; column < 3; ++column)
                for (int row = 0; row < 3; ++row)
                    words.put(a.linear[column][row]);
            for (int row = 0; row < 3; ++row)
                words.put(a.translation[row]);
        },
    .equal = [](const Graph&, const Instance& x, const Graph&,
                const Instance& y) { return x.parent_from_child == y.parent_from_child; },
    .text = [](const Graph&, const Instance& instance) -> std::string {
        const Affine& a = instance.parent_from_child;
        if (a == Affine()) return {};
        const Mat3& m = a.linear;
        const Vec3 t = a.translation;
        return numbers_line(is_singular(a) ? "    projection" : "    matrix",
                            std::array{m[0][0], m[1][0], m[2][0], t.x, //
                                       m[0][1], m[1][1], m[2][1], t.y, //
                                       m[0][2], m[1][2], m[2][2], t.z});
    },
    .fault = [](const Graph&, const Instance& instance) -> std::string {
        const Affine& a = instance.parent_from_child;
        if (!is_finite(a)) return "has a transform that is not finite";
        return a.linear == Mat3(0.0) ? "has a linear part of zero" : "";
    },
};

constexpr Attribute tint = {
    .put =
        [](const Instance& instance, AttributeWords& words) {
            for (int channel = 0; channel < 3; ++channel)
                words.put(instance.tint.rgb[channel]);
            words.put(instance.tint.alpha);
        },
    .equal = [](const Graph&, const Instance& x, const Graph&,
                const Instance& y) { return x.tint == y.tint; },
    .text = [](const Graph&, const Instance& instance) -> std::string {
        const auto& [rgb, alpha] = instance.tint;
        if (instance.tint == Tint()) return {};
        return numbers_line("    tint", std::array{rgb.r, rgb.g, rgb.b, alpha});
    },
    .fault = [](const Graph&, const Instance& instance) -> std::string {
        const auto& [rgb, alpha] = instance.tint;
        const std::array parts = {rgb.r, rgb.g, rgb.b, alpha};
        if (std::ranges::all_of(parts, [](double part) { return part >= 0 && part <= 1; })) return {};
        return fmt::format("has tint ({}, {}, {}) {} outside [0, 1]", rgb.r, rgb.g, rgb.b, alpha);
    },
};

inline const Material* material_of(const Graph& graph, const Instance& instance) {
    return instance.material ? &graph.materials[*instance.material] : nullptr;
}

constexpr Attribute material = {
    .put =
        [](const Instance& instance, AttributeWords& words) {
            words.put(instance.material ? *instance.material + std::uint64_t{1} : std::uint64_t{0});
        },
    .equal =
        [](const Graph& a, const Instance& x, const Graph& b, const Instance& y) {
            const Material *const of_x = material_of(a, x), *const of_y = material_of(b, y);
            return of_x && of_y ? *of_x == *of_y : of_x == of_y;
        },
    .text = [](const Graph& graph, const Instance& instance) -> std::string {
        const Material* const material = material_of(graph, instance);
        return material ? "    material: " + material->name + "\n" : "";
    },
    .fault = [](const Graph& graph, const Instance& instance) -> std::string {
        if (!instance.material || *instance.material < graph.materials.size()) return {};
        return fmt::format("has material {} of {}", *instance.material, graph.materials.size());
    },
};

constexpr Attribute levels = {
    .put = [](const Instance& instance, AttributeWords& words) { words.put(std::uint64_t{instance.levels}); },
    .equal = [](const Graph&, const Instance& x, const Graph&,
                const Instance& y) { return x.levels == y.levels; },
    .text = [](const Graph&, const Instance& instance) -> std::string {
        if (instance.levels == levels_of_master) return {};
        return fmt::format("    // levels: {}\n", instance.levels);
    },
    .fault = [](const Graph&, const Instance&) { return std::string(); },
};

constexpr Attribute chance = {
    .put = [](const Instance& instance, AttributeWords& words) { words.put(instance.chance); },
    .equal = [](const Graph&, const Instance& x, const Graph&,
                const Instance& y) { return x.chance == y.chance; },
    .text = [](const Graph&, const Instance& instance) -> std::string {
        return instance.chance > 0 ? numbers_line("    chance", std::array{instance.chance}) : "";
    },
    .fault = [](const Graph&, const Instance& instance) -> std::string {
        if (instance.chance >= 0 && std::isfinite(instance.chance)) return {};
        return fmt::format("has a chance of {}", instance.chance);
    },
};

} // namespace attribute_rows

std::span<const Attribute> instance_attributes() {
    using namespace attribute_rows;
    static constexpr std::array table = {place, tint, material, levels, chance};
    return table;
}

AttributeWords attribute_words(const Instance& instance) {
    AttributeWords words;
    for (const Attribute& attribute : instance_attributes())
        attribute.put(instance, words);
    return words;
}

bool equal_attributes(const Graph& a, const Instance& x, const Graph& b, const Instance& y) {
    return std::ranges::all_of(instance_attributes(),
                               [&](const Attribute& attribute) { return attribute.equal(a, x, b, y); });
}

std::string numbers_line(std::string_view key, std::span<const double> numbers) {
    std::string line(key);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        line += i == 0 ? ": " : ", ";
        line += shortest(numbers[i]);
    }
    return line + '\n';
}

} // namespace graftal
