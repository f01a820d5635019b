#include "runtime/export/formats.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "compiler/support/alternatives.h"
#include "compiler/support/small_letters.h"

namespace graftal {

std::span<const ExportFormat> export_formats() {
    static const std::array table = {usd_format, gltf_format, glb_format,  obj_format,    ply_format,
                                     stl_format, svg_format,  pbrt_format, mitsuba_format};
    return table;
}

const ExportFormat* find_export_format(std::string_view path) {
    const std::string extension = in_small_letters(std::filesystem::path(path).extension().string());
    for (const ExportFormat& format : export_formats())
        if (format.extension == extension) return &format;
    return nullptr;
}

std::string export_endings() {
    return alternatives(export_formats(), [](const ExportFormat& format) { return format.extension; });
}

std::string endings_with(bool ExportFormat::*has) {
    std::string text;
    for (const ExportFormat& format : export_formats())
        if (format.*has) text += (text.empty() ? "" : ", ") + std::string(format.extension);
    return text;
}

const ExportWish* find_vain_wish(const ExportFormat& format, const ExportOptions& options) {
    using Options = ExportOptions;
    static constexpr ExportWish wishes[] = {
        {"unit", [](const Options& o) { return o.unit_mm.has_value(); }, &ExportFormat::has_unit},
        {"part", [](const Options& o) { return !o.parts.empty(); }, &ExportFormat::has_parts},
        {"plotter", [](const Options& o) { return o.plotter; }, &ExportFormat::has_plotter},
        {"levels", [](const Options& o) { return o.levels.has_value(); }, &ExportFormat::has_levels},
        {"nodes", [](const Options& o) { return o.nodes.has_value(); }, &ExportFormat::has_nodes},
        {"instancing", [](const Options& o) { return o.instancing; }, &ExportFormat::has_instancing},
    };
    for (const ExportWish& wish : wishes)
        if (wish.asked(options) && !(format.*wish.has)) return &wish;
    return nullptr;
}

void refuse_as_too_large(const ExportJob& job, std::string problem, std::string_view hint) {
    job.too_large = true;
    job.diagnostics.error(job.model, std::move(problem)).with_hint(std::string(hint));
}

} // namespace graftal
