#pragma once

// Formats: rows of the table that the command, its help and the manual read.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/support/diagnostics.h"
#include "compiler/support/status.h"
#include "compiler/unfolded/build_scene.h"
#include "compiler/unfolded/scene.h"
#include "runtime/image_files/image_files.h"
#include "runtime/image_files/texture_store.h"

namespace graftal {

/// Options of an export besides the model and its view.
struct ExportOptions {
    std::string output;
    std::uint64_t most_bytes = std::uint64_t{1} << 30;     ///< of a file
    std::uint64_t fitted_bytes = std::uint64_t{128} << 20; ///< of a file whose error graftal chooses
    std::optional<double> unit_mm;                         ///< millimetres that a unit of the model measures
    std::optional<unsigned> levels;                        ///< instances within instances, at most
    bool instancing = false;
    bool plotter = false;
    std::vector<std::string> parts;                      ///< names of those that stay meshes of their own
    std::uint64_t memory_bytes = std::uint64_t{2} << 30; ///< most memory to use
    std::optional<std::size_t> nodes; ///< at most, of formats that share meshes only; default_nodes
    ImageMetadata metadata;

    static constexpr std::size_t default_nodes = 30'000;
};

/// The work for a format: a scene, and where to write it.
struct ExportJob {
    UnfoldedScene& scene;
    const View& view;
    const ExportOptions& options;
    Span model; ///< for diagnostics
    TextureStore& textures;
    const CancelFlag& cancel;
    Diagnostics& diagnostics;
    /// Set where the model has too much for the file: a larger error may help. Diagnostics or the status say
    /// it.
    bool& too_large;
};

/// An error among the job's diagnostics, which a model with fewer parts may not have.
void refuse_as_too_large(const ExportJob& job, std::string problem, std::string_view hint);

/// An account of the file for the user.
struct ExportReport {
    std::string summary; ///< such as "12 meshes, 1200 nodes"
};

struct ExportFormat {
    std::string_view extension; ///< with its point
    std::string_view name;
    std::string_view summary;
    SceneMeshes meshes = SceneMeshes::shared;
    bool has_unit = false;       ///< takes --unit
    bool has_levels = false;     ///< takes --levels
    bool has_instancing = false; ///< takes --instancing
    bool has_nodes = false;      ///< takes --nodes
    bool has_plotter = false;    ///< takes --plotter
    bool has_parts = false;      ///< takes --part
    /// Writes the files, whole or not at all. A model that it cannot hold is an error among the diagnostics.
    Status (*write)(const ExportJob& job, ExportReport& report);
};

std::span<const ExportFormat> export_formats();

/// The format that the ending of a file's name asks for; null if there is none.
const ExportFormat* find_export_format(std::string_view path);

/// ".obj, .ply or .stl"
std::string export_endings();
/// The endings of the formats that have it.
std::string endings_with(bool ExportFormat::*has);

/// An option that is for some formats only.
struct ExportWish {
    std::string_view option; ///< of the command line, without its dashes
    bool (*asked)(const ExportOptions& options);
    bool ExportFormat::*has;
};
/// One that is asked for and that the format has no use for; null if there is none.
const ExportWish* find_vain_wish(const ExportFormat& format, const ExportOptions& options);

// Rows.
extern const ExportFormat obj_format, ply_format, stl_format, gltf_format, glb_format, usd_format, svg_format,
    pbrt_format, mitsuba_format;

} // namespace graftal
