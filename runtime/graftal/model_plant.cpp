#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "compiler/lower/plant.h"
#include "compiler/session/stages.h"
#include "runtime/graftal/model_parts.h"
#include "runtime/plants/measures_report.h"
#include "runtime/plants/plant_of_model.h"

namespace graftal::v1 {

namespace {

/// The notes of a lowering that keeps something in place of a graph.
std::shared_ptr<const LoweredModel> lowered_in_place(Session& session, StageOptions stages,
                                                     LowerOptions::InPlace wanted, Compilation& compilation) {
    stages.lower.in_place = wanted;
    stages.lower.may_be_orbit = true;
    std::shared_ptr<const LoweredModel> lowered = session.lowered(stages, compilation);
    if (!lowered || compilation.diagnostics.has_errors()) return nullptr;
    if (lowered->notes.word || lowered->notes.plant) return lowered;
    compilation.diagnostics.error(Span(), "only L-systems have a word and its modules");
    return nullptr;
}

PlantTable table_of(const Plant& plant) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const auto row_or_none = [](std::uint32_t row) {
        return row == PlantModule::none ? -1 : std::int64_t{row};
    };
    PlantTable table;
    for (const PlantModule& module : plant.modules)
        table.parameter_count = std::max(table.parameter_count, module.parameters.size());
    for (const PlantModule& module : plant.modules) {
        table.names.push_back(plant.names[module.name]);
        table.parents.push_back(row_or_none(module.parent));
        table.branches.push_back(module.branches);
        table.orders.push_back(module.order);
        table.ranks.push_back(module.rank);
        table.parts_of.push_back(row_or_none(module.part_of));
        table.organs.emplace_back(name_of(module.organ));
        table.materials.push_back(module.material == PlantModule::no_name ? ""
                                                                          : plant.materials[module.material]);
        table.ages.push_back(module.age);
        table.lengths.push_back(module.length);
        table.widths.push_back(module.width);
        table.areas.push_back(module.is_measured ? module.area : unknown);
        table.volumes.push_back(module.is_measured ? module.volume : unknown);
        for (const auto& [of, vector] : {std::pair(&table.starts, module.start),
                                         {&table.ends, module.end},
                                         {&table.headings, module.heading},
                                         {&table.lefts, module.left},
                                         {&table.ups, module.up}})
            of->insert(of->end(), {vector.x, vector.y, vector.z});
        table.parameters.insert(table.parameters.end(), module.parameters.begin(), module.parameters.end());
        table.parameters.resize(table.names.size() * table.parameter_count, unknown);
    }
    return table;
}

} // namespace

Result<std::string> Model::word() {
    return parts_->run<std::string>([this](Compilation& compilation) -> std::optional<std::string> {
        const auto lowered = lowered_in_place(parts_->session, parts_->options.compile,
                                              LowerOptions::InPlace::word, compilation);
        return lowered ? lowered->notes.word : std::nullopt;
    });
}

Result<PlantTable> Model::plant() {
    return parts_->run<PlantTable>([this](Compilation& compilation) -> std::optional<PlantTable> {
        const auto lowered = lowered_in_place(parts_->session, parts_->options.compile,
                                              LowerOptions::InPlace::plant, compilation);
        if (!lowered || !lowered->notes.plant) return std::nullopt;
        return table_of(*lowered->notes.plant);
    });
}

Result<PlantReport> Model::measures(const MeasureSettings& settings) {
    return parts_->run<PlantReport>([&](Compilation& compilation) -> std::optional<PlantReport> {
        const bool has_samples = settings.samples >= 4 || settings.samples == 0;
        if ((settings.ground_area && !(*settings.ground_area > 0)) || !has_samples) {
            compilation.status = Status::failure("ground_area is not above 0, or samples is less than 4");
            return std::nullopt;
        }
        const StageOptions& stages = parts_->options.compile;
        const auto [plant, totals] =
            plant_or_totals_of_model(parts_->session, stages, settings.irradiance, compilation);
        PlantReport report;
        if (totals) {
            report.json = totals_json(parts_->path, *totals, settings.ground_area);
            return report;
        }
        if (!plant) return std::nullopt;
        const auto measures =
            measures_of_model(parts_->session, stages, *plant, settings.ground_area, compilation);
        if (!measures) return std::nullopt;
        std::optional<PlantLight> light;
        if (settings.irradiance) {
            light = light_of_model(parts_->session, parts_->options, *plant,
                                   parts_->light_options(settings.samples), compilation);
            if (!light) return std::nullopt;
            for (const OrganLight& organ : light->organs) {
                report.lights.push_back(organ.light);
                report.errors.push_back(organ.error);
                report.absorbed.push_back(organ.absorbed);
                report.sunlit.push_back(organ.sunlit);
            }
        }
        report.json = measures_json(parts_->path, *measures, light ? &*light : nullptr);
        return report;
    });
}

} // namespace graftal::v1
