#include "runtime/plants/measures_report.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "compiler/support/printable.h"

namespace graftal {

namespace {

using Json = nlohmann::ordered_json;

constexpr MeasuresKey keys[] = {
    {"model", "the file"},
    {"steps", "derivation steps, with the elapsed share of the next one"},
    {"modules", "letters of the word that mean something: rows of 'export plant.csv' without part_of"},
    {"segments", "segments with a length"},
    {"tips", "segments that bear no segment"},
    {"leaves", "polygons, discs, and models made of what is flat only"},
    {"balls", "spheres: neither wood nor leaves"},
    {"unmeasured", "models whose area is not known; they are in no sum"},
    {"length", "of all segments together, in the model's units, as all lengths here"},
    {"wood area", "of the segments' outsides, without their ends"},
    {"wood volume", "of the segments"},
    {"leaf area", "of one side of the leaves"},
    {"leaf inclination", "mean angle of leaf planes to the horizontal, in degrees, by area"},
    {"height", "from the lowest point of an organ to the highest"},
    {"crown area", "the convex hull of all organs, seen from above"},
    {"ground area", "the area that leaf area index and light are taken for: --ground-area, else crown area"},
    {"leaf_area_index", "leaf area over ground area"},
    {"path longest", "most segments' length from the root to a tip"},
    {"path mean", "its mean over all tips"},
    {"angle mean", "between a branch's first segment and the segment that bears it, in degrees"},
    {"angle deviation", "standard deviation of these angles"},
    {"angle branches", "how many there are"},
    {"branching_ratio", "Horton's: the factor by which streams grow in number from one Strahler order to the "
                        "order below, by regression"},
    {"light share",
     "light that the plant takes, over what falls on the ground area in the open (--irradiance)"},
    {"light absorbed", "light that the plant takes, over what falls on a unit of open ground"},
    {"light absorbed_error", "standard error of it, by its samples"},
    {"light absorbed_by_leaves", "the leaves' part of it"},
    {"light absorbed_by_leaves_error", "standard error of that, likewise"},
    {"light falls", "light on the plant before it meets anything else"},
    {"light falls_error", "standard error of it, by its samples"},
    {"light taken", "where that light ends, followed by chance: in the plant"},
    {"light to_sky", "in the sky"},
    {"light to_ground", "in the ground"},
    {"light left", "nowhere yet, when it was so little that it was given up"},
    {"light sunlit_leaf_area", "the part of the leaf area that the sun shines on; - without a sun"},
    {"light shaded_leaf_area", "the rest of the leaf area"},
    {"light samples", "samples of each organ"},
    {"light rays", "rays of all samples"},
    {"light given_up", "rays that met too many parts"},
    {"projected",
     "table: area in projection along parallel rays, at each height, mean over all sides; organs "
     "may hide each other"},
    {"projected elevation", "height of the direction over the horizon, in degrees; 90 is from above"},
    {"projected leaf_area", "leaf area in projection"},
    {"projected wood_area", "area of the segments in projection, without their ends"},
    {"projected leaf_share", "leaf area in projection, over leaf area: the function G of Ross"},
    {"orders", "table: axes by order: 0 of the main axis, one more for each branching"},
    {"orders order", "the order"},
    {"orders axes", "axes that begin in it"},
    {"orders angle", "mean branching angle of its axes, in degrees"},
    {"orders deviation", "standard deviation of these angles"},
    {"strahler", "table: streams by Strahler's order: chains of segments of that order"},
    {"strahler order", "the order; 1 of segments that bear none"},
    {"strahler streams", "number of streams"},
    {"strahler ratio", "streams over those of the next order"},
    {"strahler segments", "their segments"},
    {"strahler length", "length of them all"},
    {"strahler mean_length", "mean length of a stream"},
    {"strahler mean_width", "mean diameter, by length"},
    {"ranks", "table: organs by the rank of their modules on their axes"},
    {"ranks rank", "the rank, from 0"},
    {"names", "table: organs by their modules' names"},
    {"names name", "the name; { is a polygon"},
    {"materials", "table: organs by their materials"},
    {"materials material", "the name; - of models, which have their own"},
    {"orders modules", "in this and other tables: modules of the word"},
    {"orders segments", "segments with a length"},
    {"orders leaves", "leaves"},
    {"orders length", "length of segments"},
    {"orders wood_area", "area of segments"},
    {"orders wood_volume", "volume of segments"},
    {"orders leaf_area", "area of leaves, one side"},
};

template<typename Value> Json or_null(const std::optional<Value>& value) {
    return value ? Json(*value) : Json(nullptr);
}

/// A number, or null where there is none.
Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// A number where programs hold it exactly, else its digits in a string.
Json count(const BigCount& value) {
    constexpr std::uint64_t exact = 1ull << 53;
    return value <= exact ? Json(value.convert_to<std::uint64_t>()) : Json(value.str());
}

/// Adds the sums to a row.
Json with_sums(Json row, const PlantSums& sums) {
    row.update({{"modules", count(sums.modules)},
                {"segments", count(sums.segments)},
                {"leaves", count(sums.leaves)},
                {"length", sums.length},
                {"wood_area", sums.wood_area},
                {"wood_volume", sums.wood_volume},
                {"leaf_area", sums.leaf_area}});
    return row;
}

Json names_json(const std::vector<NamedSums>& all, const char* key) {
    Json rows = Json::array();
    for (const NamedSums& sums : all)
        if (!sums.empty())
            rows.push_back(with_sums({{key, sums.name.empty() ? Json(nullptr) : Json(sums.name)}}, sums));
    return rows;
}

Json orders_json(const PlantMeasures& measures) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < measures.orders.size(); ++i) {
        const AxisOrder& order = measures.orders[i];
        rows.push_back(with_sums({{"order", i},
                                  {"axes", order.axes},
                                  {"angle", number(order.angle_deg.mean())},
                                  {"deviation", number(order.angle_deg.deviation())}},
                                 order));
    }
    return rows;
}

Json strahler_json(const PlantMeasures& measures) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < measures.streams.size(); ++i) {
        const StreamOrder& order = measures.streams[i];
        const auto streams = static_cast<double>(order.streams);
        Json ratio = nullptr;
        if (i + 1 < measures.streams.size())
            ratio = number(streams / static_cast<double>(measures.streams[i + 1].streams));
        rows.push_back({{"order", i + 1},
                        {"streams", order.streams},
                        {"ratio", ratio},
                        {"segments", order.segments},
                        {"length", order.length},
                        {"mean_length", number(order.length / streams)},
                        {"mean_width", number(order.width_length / order.length)}});
    }
    return rows;
}

Json projected_json(const PlantMeasures& measures) {
    Json rows = Json::array();
    for (const Projected& some : measures.projected)
        rows.push_back({{"elevation", some.elevation_deg},
                        {"leaf_area", some.leaf_area},
                        {"wood_area", some.wood_area},
                        {"leaf_share", number(some.leaf_area / measures.all.leaf_area)}});
    return rows;
}

Json ranks_json(const PlantMeasures& measures) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < measures.ranks.size(); ++i)
        if (!measures.ranks[i].empty()) rows.push_back(with_sums({{"rank", i}}, measures.ranks[i]));
    return rows;
}

Json light_json(const PlantLight& light, double ground_area) {
    return {{"share", number(light.absorbed.amount / ground_area)},
            {"absorbed", light.absorbed.amount},
            {"absorbed_error", light.absorbed.error},
            {"absorbed_by_leaves", light.absorbed_by_leaves.amount},
            {"absorbed_by_leaves_error", light.absorbed_by_leaves.error},
            {"falls", light.falls.amount},
            {"falls_error", light.falls.error},
            {"taken", light.taken},
            {"to_sky", light.to_sky},
            {"to_ground", light.to_ground},
            {"left", light.left},
            {"sunlit_leaf_area", light.has_sun ? Json(light.sunlit_leaf_area) : Json(nullptr)},
            {"shaded_leaf_area", light.has_sun ? Json(light.shaded_leaf_area) : Json(nullptr)},
            {"samples", light.samples},
            {"rays", light.rays},
            {"given_up", light.given_up}};
}

Json json_of(std::string_view model, const PlantMeasures& measures, const PlantLight* light) {
    const PlantSums& all = measures.all;
    Json json = {
        {"model", model},
        {"steps", measures.steps},
        {"modules", count(all.modules)},
        {"segments", count(all.segments)},
        {"tips", measures.tips},
        {"leaves", count(all.leaves)},
        {"balls", measures.balls},
        {"unmeasured", measures.unmeasured},
        {"length", all.length},
        {"wood", {{"area", all.wood_area}, {"volume", all.wood_volume}}},
        {"leaf", {{"area", all.leaf_area}, {"inclination", number(measures.leaf_inclination_deg)}}},
        {"height", measures.height},
        {"crown", {{"area", measures.crown_area}}},
        {"ground", {{"area", measures.ground()}}},
        {"leaf_area_index", number(all.leaf_area / measures.ground())},
        {"path", {{"longest", measures.longest_path}, {"mean", measures.mean_path}}},
        {"angle",
         {{"mean", number(measures.angle_deg.mean())},
          {"deviation", number(measures.angle_deg.deviation())},
          {"branches", measures.angle_deg.count()}}},
        {"branching_ratio", or_null(measures.branching_ratio)},
    };
    if (light) json["light"] = light_json(*light, measures.ground());
    json.update({{"projected", projected_json(measures)},
                 {"orders", orders_json(measures)},
                 {"strahler", strahler_json(measures)},
                 {"ranks", ranks_json(measures)},
                 {"names", names_json(measures.names, "name")},
                 {"materials", names_json(measures.materials, "material")}});
    return json;
}

Json json_of(std::string_view model, const PlantTotals& totals, std::optional<double> ground_area) {
    const PlantSums& all = totals.all;
    Json orders = Json::array();
    for (std::size_t i = 0; i < totals.orders.size(); ++i)
        orders.push_back(with_sums({{"order", i}}, totals.orders[i]));
    Json json = {
        {"model", model},
        {"steps", totals.steps},
        {"modules", count(all.modules)},
        {"segments", count(all.segments)},
        {"leaves", count(all.leaves)},
        {"balls", count(totals.balls)},
        {"unmeasured", count(totals.unmeasured)},
        {"length", all.length},
        {"wood", {{"area", all.wood_area}, {"volume", all.wood_volume}}},
        {"leaf", {{"area", all.leaf_area}}},
    };
    if (ground_area) {
        json["ground"] = {{"area", *ground_area}};
        json["leaf_area_index"] = number(all.leaf_area / *ground_area);
    }
    json.update({{"orders", orders},
                 {"names", names_json(totals.names, "name")},
                 {"materials", names_json(totals.materials, "material")}});
    return json;
}

std::string cell(const Json& value) {
    if (value.is_string()) return escaped(value.get<std::string>(), 60);
    if (value.is_null()) return "-";
    return value.is_number_float() ? fmt::format("{:.6g}", value.get<double>()) : value.dump();
}

/// Rows under a line of their keys, in columns as wide as their longest cell.
std::string table(const std::string& name, const Json& rows) {
    if (rows.empty()) return "";
    std::vector<std::vector<std::string>> lines(1);
    for (const auto& [key, value] : rows.front().items())
        lines.front().push_back(key);
    for (const Json& row : rows) {
        std::vector<std::string>& line = lines.emplace_back();
        for (const Json& value : row)
            line.push_back(cell(value));
    }
    std::vector<std::size_t> widths(lines.front().size(), 0);
    for (const std::vector<std::string>& line : lines)
        for (std::size_t i = 0; i < line.size(); ++i)
            widths[i] = std::max(widths[i], line[i].size());
    std::string text = "\n" + name + "\n";
    for (const std::vector<std::string>& line : lines) {
        for (std::size_t i = 0; i < line.size(); ++i)
            text += fmt::format("  {:>{}}", line[i], widths[i]);
        text += '\n';
    }
    return text;
}

std::string text_of_json(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// A line a key, and a table for each list.
std::string text_for_people(const Json& json) {
    std::string lines, tables;
    const auto add = [&lines](const std::string& key, const Json& value) {
        lines += fmt::format("{:<30} {}\n", key, cell(value));
    };
    for (const auto& [key, value] : json.items()) {
        if (value.is_array()) {
            tables += table(key, value);
        } else if (value.is_object()) {
            for (const auto& [inner, number_of_it] : value.items())
                add(key + " " + inner, number_of_it);
        } else {
            add(key, value);
        }
    }
    return lines + tables;
}

} // namespace

std::string measures_json(std::string_view model, const PlantMeasures& measures, const PlantLight* light) {
    return text_of_json(json_of(model, measures, light));
}

std::string measures_text(std::string_view model, const PlantMeasures& measures, const PlantLight* light) {
    return text_for_people(json_of(model, measures, light));
}

std::string totals_json(std::string_view model, const PlantTotals& totals,
                        std::optional<double> ground_area) {
    return text_of_json(json_of(model, totals, ground_area));
}

std::string totals_text(std::string_view model, const PlantTotals& totals,
                        std::optional<double> ground_area) {
    return text_for_people(json_of(model, totals, ground_area));
}

std::span<const MeasuresKey> measures_keys() {
    return keys;
}

} // namespace graftal
