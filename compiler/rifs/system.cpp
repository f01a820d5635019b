#include "compiler/rifs/system.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "compiler/lower/lower_transform.h"
#include "compiler/lower/point_maps.h"
#include "compiler/support/check.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"

namespace graftal {

namespace {

constexpr double probability_slack = 0.02;

class SystemBuilder {
  public:
    SystemBuilder(const RifsFile& file, const Environment& lets, RifsLooks& looks, Diagnostics& diagnostics)
        : file_(file), lets_(lets), looks_(looks), diagnostics_(diagnostics) {}

    RifsSystem build() && {
        const RifsBlock* main = nullptr;
        for (const RifsBlock& block : file_.blocks) {
            add_block(block);
            if (!block.is_main) continue;
            if (main)
                diagnostics_.error(block.name.span, "a second 'main' block")
                    .with_note(main->name.span, "the first is here");
            main = &block;
        }
        if (!system_.blocks.empty()) {
            system_.main = static_cast<std::uint32_t>(system_.blocks.size() - 1);
            if (main) system_.main = static_cast<std::uint32_t>(main - file_.blocks.data());
        }
        return std::move(system_);
    }

  private:
    void add_block(const RifsBlock& block) {
        check_name(block.name, "a block", block_names_);
        RifsSubsystem subsystem;
        subsystem.source = &block;
        subsystem.first = static_cast<std::uint32_t>(system_.nodes.size());
        map_names_.clear();
        for (const RifsMap& map : block.maps)
            add_node(map);
        subsystem.end = static_cast<std::uint32_t>(system_.nodes.size());
        if (block.maps.empty() && !block.broken)
            diagnostics_.error(block.name.span, fmt::format("'rifs {}' has no maps", block.name.text))
                .with_hint("map NAME { scale 1/2  translate 1, 0, 0 }, or rows of 'codes 2d { ... }'");
        check_probabilities(block);
        system_.blocks.push_back(std::move(subsystem));
    }

    void add_node(const RifsMap& map) {
        RifsNode node;
        node.source = &map;
        node.block = static_cast<std::uint32_t>(system_.blocks.size());
        node.name = map.name.text.empty() ? fmt::format("w{}", map.number) : std::string(map.name.text);
        check_name({node.name, map.name.span}, "a map", map_names_);
        if (!map.broken && !diagnostics_.full()) {
            node.map = evaluate_map(map).value_or(Affine());
            node.tint = looks_.tint(map.look);
            node.material = looks_.material(map.look);
            const bool is_row = map.form != RifsForm::transforms;
            node.probability =
                evaluate_probability(map.probability, lets_, diagnostics_, is_row ? map.number : 0);
            sum_ += node.probability.value_or(0);
        }
        system_.nodes.push_back(std::move(node));
    }

    using Names = std::unordered_map<std::string, Span>;

    void check_name(const Name& name, std::string_view what, Names& names) {
        if (is_reserved_name(name.text))
            diagnostics_.error(name.span,
                               fmt::format("'{}' is a primitive and cannot name {}", name.text, what));
        if (name.text.find('.') != std::string_view::npos)
            diagnostics_.error(name.span,
                               fmt::format("the name '{}' of {} must not have a '.'", name.text, what));
        const auto [first, fresh] = names.try_emplace(std::string(name.text), name.span);
        if (fresh) return;
        const std::string_view kind = what == "a map" ? "map" : "rifs";
        diagnostics_.error(name.span, fmt::format("duplicate {} '{}'", kind, name.text))
            .with_note(first->second, "first defined here");
    }

    std::optional<Affine> evaluate_map(const RifsMap& map) {
        if (map.form == RifsForm::transforms) return lower_transforms(map.transforms, lets_, diagnostics_);
        std::vector<double> numbers;
        for (const Expression& code : map.codes) {
            const std::optional<double> number = evaluate(code, lets_, diagnostics_);
            if (!number)
                return std::nullopt; // one mistake for each row, such as one with the names of its columns
            numbers.push_back(*number);
        }
        if (map.form == RifsForm::codes_barycentric && !check_weights(map, numbers)) return std::nullopt;
        const Affine result = map_from_codes(map.form, numbers);
        const std::string fault = range_fault(result);
        if (fault.empty()) return result;
        Diagnostic& error = diagnostics_.error(map.span, fmt::format("this row {}", fault));
        if (result.linear != Mat3(0.0))
            error.with_hint(range_hint);
        else
            error.with_hint("write 'condense sphere scale ... translate ...' for a point; of itself graftal "
                            "does so for plain zeros in a block without 'follow' and 'start'");
        return std::nullopt;
    }

    /// The weights of each image add up to 1, and the control points span what they are points of.
    bool check_weights(const RifsMap& map, const std::vector<double>& numbers) {
        constexpr double slack = 1e-6;
        const std::size_t points = control_points(numbers.size());
        for (std::size_t image = 0; image < points; ++image) {
            const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(image * points);
            const double sum = std::accumulate(first, first + static_cast<std::ptrdiff_t>(points), 0.0);
            if (std::abs(sum - 1) <= slack) continue;
            const Span span = join(map.codes[image * points].span, map.codes[(image + 1) * points - 1].span);
            diagnostics_
                .error(span, fmt::format("the weights of this image add up to {}, not 1", rounded(sum)))
                .with_hint("they are the shares of the control points in it");
            return false;
        }
        const std::vector<Vec3> control = control_of(numbers);
        if (map_by_points(control, control)) return true;
        diagnostics_.error(map.codes[points * points].span, points == 3
                                                                ? "these control points lie on one line"
                                                                : "these control points lie in one plane");
        return false;
    }

    void check_probabilities(const RifsBlock& block) {
        double sum = std::exchange(sum_, 0);
        const bool whole = std::all_of(block.maps.begin(), block.maps.end(),
                                       [](const RifsMap& map) { return map.probability && !map.broken; });
        for (const RifsPart& part : block.condense)
            sum += evaluate_probability(part.probability, lets_, diagnostics_).value_or(0);
        if (block.maps.empty() || !whole || diagnostics_.has_errors()) return;
        if (sum == 0)
            diagnostics_
                .error(block.maps.front().probability->span,
                       fmt::format("the probabilities of 'rifs {}' are all 0", block.name.text))
                .with_hint("without any of them, graftal chooses maps by their size");
        else if (std::abs(sum - 1) > probability_slack)
            diagnostics_.warning(block.name.span,
                                 fmt::format("the probabilities of 'rifs {}' add up to {}, not 1",
                                             block.name.text, rounded(sum)));
    }

    /// Sums of decimals carry rounding errors that nobody wants to read.
    static std::string rounded(double value) {
        std::string text;
        append_number(text, value, 6);
        return text;
    }

    const RifsFile& file_;
    const Environment& lets_;
    RifsLooks& looks_;
    Diagnostics& diagnostics_;
    RifsSystem system_;
    Names block_names_;
    Names map_names_;
    double sum_ = 0;
};

} // namespace

std::vector<Vec3> control_of(const std::vector<double>& codes) {
    const std::size_t points = control_points(codes.size()), dimensions = points - 1;
    std::vector<Vec3> control;
    for (std::size_t i = points * points; i < codes.size(); i += dimensions)
        control.emplace_back(codes[i], codes[i + 1], dimensions == 3 ? codes[i + 2] : 0);
    return control;
}

std::optional<double> evaluate_probability(const std::optional<Expression>& probability,
                                           const Environment& lets, Diagnostics& diagnostics,
                                           std::size_t row) {
    if (!probability) return std::nullopt;
    const std::optional<double> p = evaluate(*probability, lets, diagnostics);
    if (!p || *p == 0 || (*p >= least_size && *p <= 1)) return p;
    // Shares of less would be nothing over nothing.
    const bool tiny = *p > 0 && *p < least_size;
    Diagnostic& error = diagnostics.error(
        probability->span,
        tiny ? fmt::format("a probability must be 0 or at least 1e-100, not {}", shortest(*p))
             : fmt::format("a probability must lie between 0 and 1, not {}", shortest(*p)));
    if (row > 0)
        error.with_hint(fmt::format("it is the last number of row {}: remove the last number from all rows "
                                    "to choose maps by their size",
                                    row));
    return std::nullopt;
}

RifsLooks::RifsLooks(const Environment& lets, std::vector<Material>& materials, Diagnostics& diagnostics)
    : lets_(lets), materials_(materials), diagnostics_(diagnostics) {
    for (MaterialId id = 0; id < materials.size(); ++id)
        ids_.try_emplace(materials[id].name, id);
}

Tint RifsLooks::tint(const RifsLook& look) const {
    if (look.tint.empty()) return {};
    return lower_tint(look.tint, lets_, diagnostics_).value_or(Tint());
}

std::optional<MaterialId> RifsLooks::material(const RifsLook& look) {
    if (!look.material) return std::nullopt;
    const std::string name(look.material->text);
    if (const auto found = ids_.find(name); found != ids_.end()) return found->second;
    const std::optional<MaterialId> id = material_named(name, look.material->span, materials_, diagnostics_);
    if (id) ids_.emplace(name, *id);
    return id;
}

RifsSystem evaluate_rifs(const RifsFile& file, const Environment& lets, RifsLooks& looks,
                         Diagnostics& diagnostics) {
    return SystemBuilder(file, lets, looks, diagnostics).build();
}

Affine map_from_codes(RifsForm form, const std::vector<double>& n) {
    switch (form) {
    case RifsForm::codes_2d:
        return flat_map({n[0], n[2], 0}, {n[1], n[3], 0}, {n[4], n[5], 0});
    case RifsForm::codes_polar: {
        const Vec3 x = Affine::rotate({0, 0, 1}, n[2])({n[0], 0, 0});
        const Vec3 y = Affine::rotate({0, 0, 1}, n[3])({0, n[1], 0});
        return flat_map(x, y, {n[4], n[5], 0});
    }
    case RifsForm::codes_barycentric: {
        const std::vector<Vec3> control = control_of(n);
        std::vector<Vec3> images;
        for (std::size_t image = 0; image < control.size(); ++image) {
            images.emplace_back(0.0);
            for (std::size_t i = 0; i < control.size(); ++i)
                images.back() += n[image * control.size() + i] * control[i];
        }
        return map_by_points(control, images).value_or(Affine::scale(Vec3(0.0)));
    }
    case RifsForm::codes_3d:
        return {glm::transpose(Mat3(n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8])),
                {n[9], n[10], n[11]}};
    case RifsForm::transforms:
        break;
    }
    GRAFTAL_CHECK(false, "a transform list has no codes");
}

} // namespace graftal
