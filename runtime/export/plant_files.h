#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/lower/plant.h"
#include "compiler/session/session.h"
#include "compiler/session/stages.h"
#include "runtime/export/formats.h"

namespace graftal {

/// A format for the structure of a plant, one row a module: its name, parameters, parent, order, rank, place,
/// and what is drawn.
struct PlantFormat {
    std::string_view extension; ///< with its point
    std::string_view summary;
    /// The text of a file; nothing where it would have more bytes than that.
    std::optional<std::string> (*text)(const Plant& plant, std::uint64_t most_bytes);
};

/// The format that the ending of a file's name asks for; null if there is none.
const PlantFormat* find_plant_format(std::string_view path);

/// ".csv, .json or .mtg"
std::string plant_endings();

/// The problem with options that say nothing to the format; "" if there is none. `finds_parts`: parts are
/// asked for by their size or address.
std::string vain_plant_wish(const PlantFormat& format, const ExportOptions& options, bool finds_parts);

/// Writes the plant of an L-system to the file that the options name; its summary, or nothing after an error
/// in the compilation.
std::optional<std::string> export_plant(Session& session, StageOptions stages, const PlantFormat& format,
                                        const ExportOptions& options, Compilation& compilation);

} // namespace graftal
