#pragma once

#include <vector>

#include "compiler/lower/lowering.h"
#include "compiler/syntax/scene_statements.h"

namespace graftal {

/// The values of the `let` and `inner` statements, in the order of the text. `--set` replaces a value where
/// this is the root model. Errors: duplicates, unknown names (also of `--set`), values that are not finite,
/// inner parameters outside of [0, 1].
Environment lower_lets(const std::vector<SceneStatement>& statements, Lowering& lowering);

/// Adds a parameter to the notes of the root model. `text`: its value there.
void note_parameter(ModelParameter::Kind kind, const std::string& name, const Expression& text, double value,
                    Lowering& lowering);

/// Evaluates `let`s on top of `outer` values, which they may use and hide, and does not check that `--set`
/// names are known. `inner`: values of inner parameters, by name, in place of their own.
Environment evaluate_lets(const std::vector<SceneStatement>& statements, Environment outer,
                          Lowering& lowering, const Environment& inner = {});
/// Reports names of `--set`, and of the presets among the statements, that are neither among `known` nor of
/// `settings`; and values of presets that are no numbers.
void check_set_names(const Environment& known, const std::vector<std::string>& settings,
                     const std::vector<SceneStatement>& statements, Lowering& lowering);
/// The value that `--set` gives a setting of the root model; a `let` of that name comes first.
std::optional<double> set_value(std::string_view setting, const Environment& lets, const Lowering& lowering);

/// Adds what a preset sets to LowerOptions::set; what is set there already stays. False after an error: there
/// is no such preset, or its numbers have no value.
bool take_preset(const std::vector<SceneStatement>& statements, const std::string& name, FileId file,
                 LowerOptions& options, Diagnostics& diagnostics);

/// Fills `settings` and `materials` of `graph` from all other statements; errors for values out of range and
/// for duplicates. Material names are then known: use material_named().
void lower_settings(const std::vector<SceneStatement>& statements, const Environment& lets, Graph& graph,
                    Lowering& lowering);

/// The material of this name: of the list, else of those that every model knows (named_materials.h). Null
/// after the error "unknown material" with a suggestion.
const Material* find_material(std::string_view name, Span span, const std::vector<Material>& materials,
                              Diagnostics& diagnostics);
/// The id of a material in the list, which gets it if need be; nothing after the error of find_material().
std::optional<MaterialId> material_named(std::string_view name, Span span, std::vector<Material>& materials,
                                         Diagnostics& diagnostics);

} // namespace graftal
