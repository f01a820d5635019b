#include "compiler/graph/primitive.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr std::array<std::string_view, primitive_kind_count> kind_names = {
#define GRAFTAL_NAME(name, form) #name,
    GRAFTAL_PRIMITIVE_KINDS(GRAFTAL_NAME)
#undef GRAFTAL_NAME
};

constexpr std::array<PrimitiveForm, primitive_kind_count> kind_forms = {
#define GRAFTAL_FORM(name, form) PrimitiveForm::form,
    GRAFTAL_PRIMITIVE_KINDS(GRAFTAL_FORM)
#undef GRAFTAL_FORM
};

std::size_t index_of(PrimitiveKind kind) {
    return static_cast<std::size_t>(kind);
}

/// Names of what has no shape: of kinds, and of frusta by their steps.
struct Names {
    std::array<std::string, primitive_kind_count> kinds;
    std::array<std::string, frustum_steps> frusta;

    Names() {
        std::ranges::copy(kind_names, kinds.begin());
        for (std::size_t i = 1; i < frusta.size(); ++i)
            frusta[i] = "frustum(" + shortest(static_cast<double>(i) / frustum_steps) + ")";
    }
};

const Names& names() {
    static const Names all;
    return all;
}

} // namespace

std::size_t Primitive::hash() const {
    return std::hash<std::string_view>()(shape_name(*this)) * 31 + index_of(kind_) * 256 + steps_;
}

std::strong_ordering operator<=>(const Primitive& a, const Primitive& b) {
    if (const auto order = a.kind_ <=> b.kind_; order != 0) return order;
    if (const auto order = a.steps_ <=> b.steps_; order != 0) return order;
    return Primitive::shape_name(a) <=> Primitive::shape_name(b);
}

Primitive tapered(double top_radius) {
    const long steps = std::lround(top_radius * frustum_steps);
    if (steps <= 0) return PrimitiveKind::cone;
    if (steps >= frustum_steps) return PrimitiveKind::cylinder;
    return {PrimitiveKind::frustum, static_cast<std::uint8_t>(steps)};
}

PrimitiveForm form_of(PrimitiveKind kind) {
    return kind_forms[index_of(kind)];
}

std::string_view name_of(PrimitiveKind kind) {
    return kind_names[index_of(kind)];
}

const std::string& name_of(const Primitive& primitive) {
    if (primitive.shape()) return primitive.shape()->name();
    if (primitive == PrimitiveKind::frustum) return names().frusta[primitive.steps()];
    return names().kinds[index_of(primitive.kind())];
}

std::optional<PrimitiveKind> primitive_kind_named(std::string_view name) {
    const auto found = std::ranges::find(kind_names, name);
    if (found == kind_names.end()) return std::nullopt;
    return all_primitive_kinds[static_cast<std::size_t>(found - kind_names.begin())];
}

std::optional<Primitive> primitive_named(std::string_view name) {
    static const std::unordered_map<std::string_view, Primitive> primitives = [] {
        std::unordered_map<std::string_view, Primitive> map;
        for (const PrimitiveKind kind : all_primitive_kinds)
            if (form_of(kind) == PrimitiveForm::plain) map.emplace(name_of(kind), kind);
        for (int steps = 1; steps < frustum_steps; ++steps) {
            const Primitive frustum(PrimitiveKind::frustum, static_cast<std::uint8_t>(steps));
            map.emplace(name_of(frustum), frustum);
        }
        return map;
    }();
    const auto found = primitives.find(name);
    if (found == primitives.end()) return std::nullopt;
    return found->second;
}

} // namespace graftal
