#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "compiler/import/importer.h"
#include "compiler/lower/translator.h"

namespace graftal {

/// The formats of other programs. To add one: a room of its own in this folder, and a row of this table.
std::span<const Importer> importers();

/// The functions of this header as lowering asks for them.
Translator importing_translator();

/// "trees.l:Tree1" names the model Tree1 in the foreign file trees.l. A path that holds no ending of the
/// table before a colon is the file itself.
ModelPath model_path(std::string_view path);

/// The name for what is made of a model: "Tree1" of "lib/trees.l:Tree1", "fern" of "lib/fern.rifs".
std::string model_stem(std::string_view path);

/// Whether the name of a file has an ending of the table.
bool is_foreign(std::string_view file_name);

/// The text of a model's file from its bytes, in the encoding that they have; foreign ones may have that of
/// old Windows.
std::string model_text(std::string_view file_name, std::string bytes);

/// A file of `sources` for importers. Both must outlive it, and so must the meter. Charges the file as read.
ForeignFile foreign_file(FileId file, SourceMap& sources, Diagnostics& diagnostics,
                         TranslateOptions options = {}, WorkMeter* meter = nullptr);

/// The importer that reads the file: one of its ending that knows the text, else any that knows it, with a
/// note, else the only one of its ending. Null after the error that names the formats.
const Importer* importer_of(const ForeignFile& file);

/// The model by its name, where capitals count only if they must; "" for the only one. Nothing after the
/// error that lists the models.
std::optional<ForeignModel> find_model(const Importer& importer, const ForeignFile& file,
                                       std::string_view name);

/// The text in one of our languages of a file: the file itself, or the translation of the model of this name
/// in a foreign one, which becomes a file of `sources`. Nothing after an error. Throws OutOfWork where the
/// meter allows no more.
std::optional<FileId> own_text(FileId file, std::string_view model, SourceMap& sources,
                               Diagnostics& diagnostics, const TranslateOptions& options = {},
                               WorkMeter* meter = nullptr);

} // namespace graftal
