#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/light/sky_picture.h"
#include "compiler/lower/derivation.h"
#include "compiler/lower/translator.h"
#include "compiler/support/control.h"
#include "compiler/support/files.h"
#include "compiler/support/source.h"
#include "compiler/support/status.h"
#include "compiler/support/texture_facts.h"

namespace graftal {

struct OrbitModel;
struct Plant;
struct PlantTotals;
class ParsedFiles;

struct LowerOptions {
    std::map<std::string, double, std::less<>> set; ///< `--set NAME=VALUE`: replaces the value of a `let`
    std::string preset;            ///< of the root model: it sets what `set` does not; "": none
    std::optional<unsigned> steps; ///< derivation steps of an L-system, in place of what the model says
    /// The time to draw at, in steps. L-systems whose drawing reads the time are drawn at this age, after
    /// the steps done by then. Others take `steps` or, without these, the steps done by then. Other
    /// languages have no time: without `steps` it is an error.
    std::optional<double> time;
    std::optional<std::uint64_t> seed; ///< of what is random, in used models too
    /// Files that a model names, and the model itself, must lie in this folder, with all symbolic links
    /// resolved. Where it is "", they may lie anywhere.
    std::string root;
    /// Result that is wanted of the root model, an L-system, in place of a graph.
    enum class InPlace : std::uint8_t { nothing, word, plant, totals };
    InPlace in_place = InPlace::nothing;
    bool exact = false; ///< L-systems are derived module by module: one honest random tree
    std::uint64_t max_modules = 50'000'000; ///< of a derived word
    std::uint64_t run_from = 4096; ///< least modules of a derived word that makes a run, if little repeats
    std::size_t max_objects = 1'000'000; ///< a model that enumerates more is an error
    /// A model that draws nothing is an error; with this the root model may, with a note, and gives its
    /// `derivation` but no graph.
    bool may_draw_nothing = false;
    /// Where hues and inks would make so many objects that the work allowed does not suffice, they are left
    /// out, with a note: shapes, bounds and counts of leaves stay as they are. Else they are made.
    bool may_leave_out_colours = false;
    /// The root model may be an orbit (rifs/orbit_model.h), which has no graph; else an orbit is an error.
    bool may_be_orbit = false;
};

/// Looks at the picture that a material names.
using LookAtTexture = std::function<Status(const std::string& path, TextureFacts& facts)>;

/// Whom lowering asks on its way.
struct LowerHelp {
    LookAtTexture look_at_texture;           ///< without this, textures are taken on trust
    Control control;                         ///< follows modules, parts and objects
    LoadSkyPicture load_sky_picture = {};    ///< without this, environments are taken on trust, and are white
    Translator translator = no_translator(); ///< reads the files of other programs
    const Files* files = &no_files();        ///< that the model may name
    ParsedFiles* parsed = nullptr;           ///< of lowerings before; null: each text is parsed anew
};

/// A number of the root model that LowerOptions::set may replace.
struct ModelParameter {
    enum class Kind : std::uint8_t {
        let,
        inner,   ///< in [0, 1]
        setting, ///< of an L-system, such as its angle
    };

    Kind kind = Kind::let;
    std::string name;
    double value = 0;     ///< as it is set, or else as the text has it
    Span span;            ///< the value in the text
    bool literal = false; ///< the text has a number there, which an editor may replace; else an expression

    bool operator==(const ModelParameter&) const = default;
};

/// Facts that lowering learns beside the graph.
struct LowerNotes {
    std::optional<Derivation> derivation;         ///< of an L-system
    std::optional<std::string> word;              ///< that LowerOptions::in_place asks for
    std::shared_ptr<const Plant> plant;           ///< or null; likewise
    std::shared_ptr<const PlantTotals> totals;    ///< or null; likewise
    std::shared_ptr<const OrbitModel> orbit;      ///< or null; what is one has no graph
    std::map<std::string, FileStamp> meshes = {}; ///< by path: the files of meshes, as they were when read
    std::vector<ModelParameter> parameters = {};  ///< of the root model, in the order of its text
    bool limited_by_work = false;                 ///< with more work allowed the graph would be another
    bool asks_chance = false;                     ///< with another seed the graph may be another
};

} // namespace graftal
