#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/lower/plant.h"
#include "runtime/export/formats.h"
#include "runtime/plants/plant_of_model.h"
#include "runtime/plants/plant_tree.h"

namespace graftal {

/// A plant with what its table tells besides its modules.
struct WrittenPlant {
    const Plant& plant;
    PlantTree tree;
    const PlantLight* light = nullptr; ///< null: nobody asked for it
};

/// A format for the structure of a plant, one row a module: its name, parameters, parent, order, rank, place,
/// and what is drawn.
struct PlantFormat {
    std::string_view extension; ///< with its point
    std::string_view summary;
    /// The text of a file; nothing where it would have more bytes than that.
    std::optional<std::string> (*text)(const WrittenPlant& table, std::uint64_t most_bytes);
    std::size_t (*rows)(const Plant& plant) = nullptr; ///< number of modules that a file has; null: all
    std::string (*note)(const Plant& plant) =
        nullptr; ///< what a file has in other words; "" or null: nothing
};

/// The format that the ending of a file's name asks for; null if there is none.
const PlantFormat* find_plant_format(std::string_view path);

/// ".csv, .json or .mtg"
std::string plant_endings();

/// The problem with options that say nothing to the format; "" if there is none. `finds_parts`: parts are
/// asked for by their size or address.
std::string refusal_of_plant_options(const PlantFormat& format, const ExportOptions& options,
                                     bool finds_parts);

/// Writes the plant of an L-system to the file that the options name, with the light on its organs where
/// `light` is not null; its summary, or nothing after an error in the compilation. `render`: the stages and
/// threads.
std::optional<std::string> export_plant(PictureSession& session, const RenderOptions& render,
                                        const PlantFormat& format, const ExportOptions& options,
                                        const PlantLightOptions* light, Compilation& compilation);

} // namespace graftal
