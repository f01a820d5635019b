#include "compiler/lsys/compile/surroundings.h"

#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "compiler/lower/lower_transform.h"
#include "compiler/support/angle.h"
#include "compiler/support/number.h"
#include "compiler/support/number_range.h"

namespace graftal {

namespace {

constexpr std::size_t most_regions = 1000;
constexpr double most_shadow_depth = 64;

bool is_region(std::string_view kind) {
    return kind == "sphere" || kind == "box" || kind == "plane";
}

class SurroundingsBuilder {
  public:
    SurroundingsBuilder(const LsysBlock& block, LsysGrammar& grammar, Diagnostics& diagnostics)
        : block_(block), grammar_(grammar), diagnostics_(diagnostics) {}

    void build() {
        add_tropisms();
        if (block_.bending)
            grammar_.bending = !block_.bending->moves   ? Bending::after_segments
                               : block_.bending->before ? Bending::before_moves
                                                        : Bending::after_moves;
        for (const LsysEnvironment& statement : block_.environment)
            add(statement);
        if (block_.environment.empty()) return check_queries();
        check_regions();
        grammar_.environment = std::move(settings_);
    }

  private:
    void add_tropisms() {
        for (std::size_t i = 0; i < block_.tropisms.size(); ++i) {
            const LsysDirection& statement = block_.tropisms[i];
            const std::optional<Vec3> given = lower_vector(statement.direction, grammar_.lets, diagnostics_);
            if (!given) continue;
            const double length = glm::length(*given);
            if (!(length > 0 && std::isfinite(length))) {
                diagnostics_.error(statement.span, fmt::format("'{}' must have a direction",
                                                               statement.twists ? "torque" : "tropism"));
                continue;
            }
            TropismKind kind{.twists = statement.twists};
            if (statement.angle) {
                const std::optional<double> angle_deg =
                    evaluate(*statement.angle, grammar_.lets, diagnostics_);
                if (!angle_deg) continue;
                const auto [cosine, sine] = cos_sin_deg(*angle_deg);
                kind = {cosine, sine, false};
            }
            grammar_.tropism_kinds.push_back(kind);
            if (i == 0)
                grammar_.tropism = *given / length;
            else
                grammar_.other_tropisms.push_back(*given / length);
        }
        if (grammar_.tropism_kinds.size() == 1 && grammar_.tropism_kinds[0].is_plain())
            grammar_.tropism_kinds.clear();
        if (grammar_.other_tropisms.size() > most_other_tropisms) {
            diagnostics_.error(block_.tropisms.back().span,
                               fmt::format("a block has at most {} tropisms", 1 + most_other_tropisms));
            grammar_.other_tropisms.resize(most_other_tropisms);
            grammar_.tropism_kinds.resize(1 + most_other_tropisms);
        }
    }

    void add(const LsysEnvironment& statement) {
        std::vector<double> numbers;
        for (const Expression& expression : statement.numbers) {
            const std::optional<double> number = evaluate(expression, grammar_.lets, diagnostics_);
            if (!number) return;
            if (std::abs(*number) > largest_size)
                return refuse(statement, numbers.size(),
                              fmt::format("a number here is at most {}", shortest(largest_size)));
            numbers.push_back(*number);
        }
        if (is_region(statement.kind)) return add_region(statement, numbers);
        if (other_) {
            diagnostics_
                .error(statement.span,
                       fmt::format("'{}' and '{}' cannot both answer '?E'", other_->kind, statement.kind))
                .with_note(other_->span, "the other is given here");
            return;
        }
        other_ = &statement;
        settings_.span = statement.span;
        if (statement.kind == "crowd") add_crowd(statement, numbers);
        if (statement.kind == "rivals") add_rivals(statement, numbers);
        if (statement.kind == "shade") add_shade(statement, numbers);
        if (statement.kind == "shadows") add_shadows(statement, numbers);
        if (statement.kind == "points") add_points(statement, numbers);
    }

    /// An error about a number of a statement.
    void refuse(const LsysEnvironment& statement, std::size_t number, const std::string& message) {
        diagnostics_.error(statement.numbers[number].span, message);
    }

    bool positive(const LsysEnvironment& statement, const std::vector<double>& numbers, std::size_t k,
                  std::string_view what) {
        if (numbers[k] >= least_size) return true;
        refuse(statement, k, fmt::format("{} must be positive, not {}", what, shortest(numbers[k])));
        return false;
    }

    void add_region(const LsysEnvironment& statement, const std::vector<double>& n) {
        EnvironmentRegion region;
        region.a = {n[0], n[1], n[2]};
        region.extent = n[3];
        if (statement.kind == "sphere") {
            if (!positive(statement, n, 3, "the radius")) return;
        } else if (statement.kind == "box") {
            region.kind = EnvironmentRegion::Kind::box;
            region.b = {n[3], n[4], n[5]};
            for (int axis = 0; axis < 3; ++axis)
                if (!(region.a[axis] < region.b[axis]))
                    return refuse(statement, static_cast<std::size_t>(axis) + 3,
                                  "the greatest corner of a box lies above the least one in x, y and z");
        } else {
            region.kind = EnvironmentRegion::Kind::half_space;
            const double length = glm::length(region.a);
            if (!(length > 0)) return refuse(statement, 0, "a plane needs a direction: a, b, c not all 0");
            region.a /= length;
            region.extent /= length;
            plane_ = &statement;
        }
        if (settings_.regions.size() == most_regions) {
            diagnostics_.error(statement.span, fmt::format("a block has at most {} regions", most_regions));
            return;
        }
        if (settings_.regions.empty() && !other_) settings_.span = statement.span;
        settings_.regions.push_back(region);
    }

    void add_crowd(const LsysEnvironment& statement, const std::vector<double>& n) {
        settings_.kind = EnvironmentSettings::Kind::crowd;
        if (!positive(statement, n, 0, "the radius")) return;
        settings_.radius = n[0];
        flatten(statement, n, 1);
    }

    void add_rivals(const LsysEnvironment& statement, const std::vector<double>& n) {
        settings_.kind = EnvironmentSettings::Kind::rivals;
        flatten(statement, n, 0);
    }

    /// Flattens along the direction that begins at number k, if there is one.
    void flatten(const LsysEnvironment& statement, const std::vector<double>& n, std::size_t k) {
        if (n.size() == k) return;
        if (n.size() < k + 3) return refuse(statement, k, "a direction is x, y, z");
        const Vec3 direction(n[k], n[k + 1], n[k + 2]);
        if (!(glm::length(direction) > 0)) return refuse(statement, k, "a direction is not 0, 0, 0");
        settings_.flat = glm::normalize(direction);
    }

    void add_shade(const LsysEnvironment& statement, const std::vector<double>& n) {
        settings_.kind = EnvironmentSettings::Kind::shade;
        settings_.transmittance = n[0];
        if (!(n[0] >= 0 && n[0] <= 1))
            return refuse(statement, 0,
                          fmt::format("a transmittance lies from 0 to 1, but is {}", shortest(n[0])));
        if (n.size() % 4 != 1)
            return refuse(statement, n.size() - 1, "a source is x, y, z and its intensity");
        double sum = 0;
        for (std::size_t k = 1; k < n.size(); k += 4) {
            const Vec3 direction(n[k], n[k + 1], n[k + 2]);
            if (!(glm::length(direction) > 0)) return refuse(statement, k, "a source needs a direction");
            if (!positive(statement, n, k + 3, "an intensity")) return;
            settings_.sources.push_back({glm::normalize(direction), n[k + 3]});
            sum += n[k + 3];
        }
        for (EnvironmentSource& source : settings_.sources)
            source.intensity /= sum;
    }

    void add_shadows(const LsysEnvironment& statement, const std::vector<double>& n) {
        settings_.kind = EnvironmentSettings::Kind::shadows;
        if (!positive(statement, n, 0, "the size of a voxel")) return;
        if (!positive(statement, n, 2, "the decay")) return;
        if (!(n[3] >= 0 && n[3] <= most_shadow_depth && n[3] == std::floor(n[3])))
            return refuse(statement, 3,
                          fmt::format("the depth is a whole number from 0 to {}, not {}", most_shadow_depth,
                                      shortest(n[3])));
        settings_.voxel = n[0];
        settings_.strength = n[1];
        settings_.decay = n[2];
        settings_.depth = static_cast<unsigned>(n[3]);
    }

    void add_points(const LsysEnvironment& statement, const std::vector<double>& n) {
        settings_.kind = EnvironmentSettings::Kind::points;
        if (!(n[0] >= 1 && n[0] <= max_attraction_points && n[0] == std::floor(n[0])))
            return refuse(statement, 0,
                          fmt::format("the count is a whole number from 1 to {}, not {}",
                                      max_attraction_points, shortest(n[0])));
        if (!positive(statement, n, 1, "the distance of influence")) return;
        if (!(n[2] >= 0))
            return refuse(statement, 2,
                          fmt::format("the distance of removal is not negative, but is {}", shortest(n[2])));
        settings_.point_count = static_cast<std::uint32_t>(n[0]);
        settings_.influence = n[1];
        settings_.kill = n[2];
    }

    /// Points lie in regions that end; else regions answer by themselves.
    void check_regions() {
        if (!other_) return;
        if (other_->kind != "points") {
            if (!settings_.regions.empty())
                diagnostics_.error(other_->span, fmt::format("'{}' takes no regions", other_->kind));
        } else if (settings_.regions.empty()) {
            diagnostics_.error(other_->span, "'points' needs a region that holds them")
                .with_hint("write environment sphere x, y, z, radius, or environment box with two corners");
        } else if (plane_) {
            diagnostics_.error(plane_->span,
                               "the points of 'points' need regions that end: spheres or boxes");
        }
    }

    void check_queries() {
        if (block_.broken) return; // an environment may be lost
        for (SymbolId id = 0; id < grammar_.symbols.size(); ++id)
            if (grammar_.commands[id] == TurtleCommand::ask_environment) {
                diagnostics_
                    .warning(grammar_.first_uses[id], "'?E' hears nothing: the block has no environment")
                    .with_hint("write a statement such as environment sphere 0, 5, 0, 5");
                return;
            }
    }

    const LsysBlock& block_;
    LsysGrammar& grammar_;
    Diagnostics& diagnostics_;
    EnvironmentSettings settings_;
    const LsysEnvironment* other_ = nullptr; ///< a statement that is no region
    const LsysEnvironment* plane_ = nullptr;
};

} // namespace

void build_surroundings(const LsysBlock& block, LsysGrammar& grammar, Diagnostics& diagnostics) {
    SurroundingsBuilder(block, grammar, diagnostics).build();
}

} // namespace graftal
