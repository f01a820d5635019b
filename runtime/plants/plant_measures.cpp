#include "runtime/plants/plant_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "runtime/plants/outline.h"

namespace graftal {

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
/// Seconds of one processor for a row or a triangle, with all directions.
constexpr double price = 5e-7;

constexpr std::array<double, 7> elevations_deg = {90, 75, 60, 45, 30, 15, 0};
constexpr std::size_t azimuths = 16;

/// Unit vectors around the vertical, at each height.
std::vector<Vec3> directions_at(double elevation_deg) {
    if (elevation_deg == 90) return {Vec3(0, 1, 0)};
    std::vector<Vec3> directions;
    const double height = glm::radians(elevation_deg);
    for (std::size_t i = 0; i < azimuths; ++i) {
        const double turn = 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / azimuths;
        directions.emplace_back(std::cos(height) * std::cos(turn), std::sin(height),
                                std::cos(height) * std::sin(turn));
    }
    return directions;
}

template<typename Value> Value& at(std::vector<Value>& values, std::size_t number) {
    if (number >= values.size()) values.resize(number + 1);
    return values[number];
}

Vec3 direction_of(const PlantModule& segment) {
    const Vec3 way = segment.end - segment.start;
    const double length = glm::length(way);
    return length > 0 ? way / length : segment.heading;
}

double angle_between_deg(Vec3 a, Vec3 b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

class Measurer {
  public:
    Measurer(const Plant& plant, const PlantTree& tree, const Control& control)
        : plant_(plant), tree_(tree), meter_(control, "measure", 4096, price) {
        for (const double elevation : elevations_deg) {
            measures_.projected.push_back({elevation, 0, 0});
            directions_.push_back(directions_at(elevation));
        }
        for (const std::string& name : plant.names)
            measures_.names.emplace_back().name = name;
        for (const std::string& name : plant.materials)
            measures_.materials.emplace_back().name = name;
        measures_.materials.emplace_back(); // of models that have their own
    }

    PlantMeasures run() {
        measures_.steps = plant_.steps;
        bears_.assign(plant_.modules.size(), false);
        for (std::size_t i = 0; i < plant_.modules.size(); ++i)
            if (is_segment(plant_.modules[i]) && tree_.bearer[i] != PlantModule::none)
                bears_[tree_.bearer[i]] = true;
        for (std::uint32_t i = 0; i < plant_.modules.size(); ++i) {
            meter_.add();
            add_module(i);
        }
        finish();
        return std::move(measures_);
    }

  private:
    void add_module(std::uint32_t id) {
        const PlantModule& module = plant_.modules[id];
        const PlantModule& whole =
            module.part_of == PlantModule::none ? module : plant_.modules[module.part_of];
        PlantSums sums;
        sums.modules = module.part_of == PlantModule::none ? 1 : 0;
        if (is_segment(module)) add_segment(id, sums);
        if (is_blade(module)) add_blade(id, sums);
        if (module.organ == Organ::ball) add_ball(module);
        if (module.organ == Organ::model && !module.is_measured) ++measures_.unmeasured;
        measures_.all += sums;
        at(measures_.orders, module.order) += sums;
        at(measures_.ranks, whole.rank) += sums;
        measures_.names[whole.name] += sums;
        if (module.organ == Organ::none) return;
        const std::size_t own = plant_.materials.size();
        measures_.materials[module.material == PlantModule::no_name ? own : module.material] += sums;
    }

    void add_segment(std::uint32_t id, PlantSums& sums) {
        const PlantModule& module = plant_.modules[id];
        const double mean_width = (module.base_width + module.width) / 2;
        sums.segments = 1;
        sums.length = module.length;
        sums.wood_area = module.area;
        sums.wood_volume = module.volume;
        const Vec3 along = direction_of(module);
        project([&](Vec3 d) { return mean_width * module.length * glm::length(glm::cross(along, d)); },
                &Projected::wood_area);
        const double base = module.base_width / 2; // flat, where the other end is a ball
        include_ellipse(module.start, base * module.left, base * module.up);
        include_round(module.end, module.width / 2);
        if (!bears_[id]) {
            ++measures_.tips;
            measures_.mean_path += tree_.path[id];
            measures_.longest_path = std::max(measures_.longest_path, tree_.path[id]);
        }
        const std::uint32_t bearer = tree_.bearer[id];
        AxisOrder& order = at(measures_.orders, module.order);
        const bool begins_axis = bearer == PlantModule::none || plant_.modules[bearer].order < module.order;
        if (begins_axis) ++order.axes;
        if (begins_axis && bearer != PlantModule::none) {
            const double angle = angle_between_deg(along, direction_of(plant_.modules[bearer]));
            order.angle_deg.add(angle);
            measures_.angle_deg.add(angle);
        }
        StreamOrder& stream = at(measures_.streams, tree_.strahler[id] - 1u);
        ++stream.segments;
        if (bearer == PlantModule::none || tree_.strahler[bearer] != tree_.strahler[id]) ++stream.streams;
        stream.length += module.length;
        stream.width_length += module.length * mean_width;
    }

    void add_blade(std::uint32_t id, PlantSums& sums) {
        const PlantModule& module = plant_.modules[id];
        sums.leaves = 1;
        sums.leaf_area = module.area;
        if (module.organ == Organ::disc) {
            add_facet(module.area * module.up);
            include_ellipse(module.start, module.width / 2 * module.heading, module.width / 2 * module.left);
            return;
        }
        while (next_blade_ < plant_.blades.size() && plant_.blades[next_blade_].module < id)
            ++next_blade_;
        if (next_blade_ == plant_.blades.size() || plant_.blades[next_blade_].module != id) return;
        const PlantBlade& blade = plant_.blades[next_blade_];
        for (const PlantTriangle& triangle : plant_.shapes[blade.shape]) {
            meter_.add();
            const Vec3 a = blade.world_from_shape(triangle[0]), b = blade.world_from_shape(triangle[1]),
                       c = blade.world_from_shape(triangle[2]);
            add_facet(glm::cross(b - a, c - a) / 2.0);
            for (const Vec3 corner : {a, b, c})
                include(corner);
        }
    }

    void add_ball(const PlantModule& module) {
        ++measures_.balls;
        include_round(module.start, module.width / 2);
    }

    /// A flat piece of a leaf, by its normal, which is as long as the piece is large.
    void add_facet(Vec3 normal) {
        const double area = glm::length(normal);
        project([&](Vec3 d) { return std::abs(glm::dot(normal, d)); }, &Projected::leaf_area);
        if (!(area > 0)) return;
        facet_area_ += area;
        const double tilt = std::atan2(std::hypot(normal.x, normal.z), std::abs(normal.y));
        measures_.leaf_inclination_deg += area * glm::degrees(tilt);
    }

    template<typename Area> void project(const Area& area, double Projected::*sum) {
        for (std::size_t i = 0; i < directions_.size(); ++i) {
            double total = 0;
            for (const Vec3 direction : directions_[i])
                total += area(direction);
            measures_.projected[i].*sum += total / static_cast<double>(directions_[i].size());
        }
    }

    void include(Vec3 point) {
        outline_.add({point.x, point.z});
        lowest_ = std::min(lowest_, point.y);
        highest_ = std::max(highest_, point.y);
    }

    /// The ball about a point.
    void include_round(Vec3 centre, double radius) {
        include_ellipse(centre, radius * Vec3(1, 0, 0), radius * Vec3(0, 0, 1));
        lowest_ = std::min(lowest_, centre.y - radius);
        highest_ = std::max(highest_, centre.y + radius);
    }

    /// The ellipse with these half axes.
    void include_ellipse(Vec3 centre, Vec3 a, Vec3 b) {
        const double height = std::hypot(a.y, b.y);
        outline_.add_ellipse({centre.x, centre.z}, {a.x, a.z}, {b.x, b.z});
        lowest_ = std::min(lowest_, centre.y - height);
        highest_ = std::max(highest_, centre.y + height);
    }

    void finish() {
        if (measures_.tips > 0) measures_.mean_path /= static_cast<double>(measures_.tips);
        measures_.leaf_inclination_deg /= facet_area_; // no number without leaves
        measures_.height = highest_ >= lowest_ ? highest_ - lowest_ : 0;
        measures_.crown_area = outline_.area();
        std::vector<std::uint64_t> streams;
        for (const StreamOrder& order : measures_.streams)
            streams.push_back(order.streams);
        measures_.branching_ratio = horton_ratio(streams);
    }

    const Plant& plant_;
    const PlantTree& tree_;
    WorkMeter meter_;
    PlantMeasures measures_;
    std::vector<std::vector<Vec3>> directions_; ///< by elevation
    std::vector<bool> bears_;                   ///< segments that bear segments
    Outline outline_;
    double lowest_ = std::numeric_limits<double>::infinity(), highest_ = -lowest_;
    double facet_area_ = 0;
    std::size_t next_blade_ = 0;
};

} // namespace

void RunningMean::add(double value) {
    ++count_;
    const double before = value - mean_;
    mean_ += before / static_cast<double>(count_);
    squares_ += before * (value - mean_);
}

double RunningMean::mean() const {
    return count_ > 0 ? mean_ : no_number;
}

double RunningMean::deviation() const {
    return count_ > 1 ? std::sqrt(squares_ / static_cast<double>(count_ - 1)) : no_number;
}

PlantMeasures measure_plant(const Plant& plant, const PlantTree& tree, std::optional<double> ground_area,
                            const Control& control) {
    PlantMeasures measures = Measurer(plant, tree, control).run();
    measures.ground_area = ground_area;
    return measures;
}

std::optional<double> horton_ratio(const std::vector<std::uint64_t>& counts) {
    if (counts.size() < 2) return std::nullopt;
    double mean_order = 0, mean_log = 0;
    const auto orders = static_cast<double>(counts.size());
    for (std::size_t i = 0; i < counts.size(); ++i) {
        mean_order += static_cast<double>(i) / orders;
        mean_log += std::log(static_cast<double>(counts[i])) / orders;
    }
    double products = 0, squares = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double order = static_cast<double>(i) - mean_order;
        products += order * std::log(static_cast<double>(counts[i]));
        squares += order * order;
    }
    return std::exp(-products / squares);
}

} // namespace graftal
