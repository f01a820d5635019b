#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/support/diagnostics.h"
#include "compiler/support/source.h"
#include "compiler/support/status.h"
#include "compiler/support/texture_facts.h"

namespace graftal {

/// What an L-system placed of a model with inner parameters.
struct FamilyReport {
    std::string model;                   ///< as `~` names it
    std::vector<std::string> parameters; ///< names of the inner ones
    std::size_t used = 0;                ///< different members
    std::size_t possible = 0;            ///< that the parameters are rounded to
    double error = 0;                    ///< largest distance of an argument from the value in its place
};

/// How an L-system was compiled.
struct Derivation {
    std::string way;               ///< "composed" part by part, or "derived" and then shared
    std::optional<unsigned> steps; ///< nothing: infinite
    bool timed = false;            ///< the drawing reads the time
    double time = 0;               ///< the steps, and what share of the next had passed
    std::string modules;           ///< of the word after these steps: decimal, exact
    std::string segments;          ///< that it draws
    std::size_t parts = 0;         ///< different modules with their steps and states that were composed
    double size_step = 0;       ///< widths relative to a part's size are rounded to steps of this logarithm
    std::uint32_t variants = 1; ///< of each random part
    double drift = 0; ///< relative standard error of the mean number of segments and bodies over the variants
    double error = 0; ///< bound on the displacement of any point
    std::vector<FamilyReport> families; ///< that were placed, by name
};

struct OrbitModel;

struct LowerOptions {
    std::map<std::string, double, std::less<>> set; ///< `--set NAME=VALUE`: replaces the value of a `let`
    std::optional<unsigned> steps; ///< derivation steps of an L-system, in place of what the model says
    /// Looks at the picture that a material names. Without this, textures are taken on trust.
    std::function<Status(const std::string& path, TextureFacts& facts)> look_at_texture;
    /// The same between steps: L-systems whose drawing reads the time are drawn as old as this, after as many
    /// steps as are done by then; others after `steps`, or if these are not given, too. Other languages have
    /// no time: without `steps` it is an error.
    std::optional<double> time;
    std::optional<std::uint64_t> seed; ///< of what is random, in place of what the model says
    /// Files that a model names, and the model itself, must lie in this folder, with all symbolic links
    /// resolved;
    /// "": they may lie anywhere.
    std::string root;
    bool exact = false; ///< L-systems are derived module by module: one honest random tree
    std::uint64_t max_modules = 50'000'000; ///< of a derived word
    std::uint64_t run_from = 4096; ///< derived words of so many modules make a run, if they repeat little
    std::size_t max_objects = 1'000'000; ///< a model that enumerates more is an error
    /// A model that draws nothing is an error; with this the root model may, with a note, and gives its
    /// `derivation` but no graph.
    bool may_draw_nothing = false;
    /// Where the root model goes if it is an orbit (orbit_model.h), which has no graph: then nothing comes
    /// back, but without an error. Null: an orbit is an error.
    std::shared_ptr<const OrbitModel>* orbit = nullptr;
};

/// Reads a model, and all that it uses, and lowers it to a verified graph. The language follows the file
/// name (`.inst`, `.rifs`, `.lsys`), for "-" (standard input) the first word of the text. Bad input is
/// reported to `diagnostics` and gives nothing; a root file that cannot be read gives nothing and a failed
/// `status`. `derivation` is filled where the model is an L-system. Used files are looked up beside the file
/// that names them.
std::optional<Graph> lower_model(const std::string& path, const LowerOptions& options, SourceMap& sources,
                                 Diagnostics& diagnostics, Status& status,
                                 std::optional<Derivation>* derivation = nullptr);

/// "inst", "rifs" or "lsys", by the name of the file, for standard input by its text; else whatever follows
/// the dot of the name. The file of the model itself is the first in `sources`.
std::string model_language(FileId file, const SourceMap& sources);

/// The same as lower_model for a text already at hand, as the model `name` (which decides the language and
/// where used files are looked up).
std::optional<Graph> lower_text(const std::string& name, std::string text, const LowerOptions& options,
                                SourceMap& sources, Diagnostics& diagnostics,
                                std::optional<Derivation>* derivation = nullptr);

} // namespace graftal
