#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "compiler/chaos/chaos_game.h"

namespace graftal {

/// The colour of a map by its label (ChaosPoint::map).
using LabelColour = std::function<Rgb(std::uint32_t label)>;

/// A chaos game in single precision, as arrays of a graphics card's kernel: runtime/points/kernel/points.comp
/// says what their numbers are.
struct FlatGame {
    static constexpr std::uint32_t none = UINT32_MAX;

    std::vector<glm::uvec4> choices; ///< slots of alias tables
    std::vector<glm::vec4> moves;
    std::vector<glm::uvec4> links;  ///< by move
    std::vector<glm::uvec4> states; ///< of the game, by number
    std::vector<glm::vec4> colours; ///< of materials; the last is behind a point that met none
    std::vector<glm::vec4> forms;   ///< of surfaces, by move from `first_form` on

    std::vector<glm::uvec4> steps; ///< of formulas (compiler/syntax/steps/expression_steps.h)
    std::vector<float> numbers;    ///< that the formulas name
    std::uint32_t slots = 0;       ///< of memory that the formulas need

    AliasTables::Range sources; ///< where points come from; none: all from the core
    std::uint32_t first_form = 0;
    std::uint32_t core_colour = none; ///< behind points of the core; none: as behind others
    AliasTables::Range start;         ///< of the core's points
    std::uint32_t settling = 0;       ///< moves until where a point began is forgotten
    bool formulas = false;            ///< in place of affine maps
    glm::vec4 origin{0.0};            ///< of walkers
    float restart = 0;                ///< OrbitModel::restart
    bool climbs = false;              ///< points go from their core up to the root
    bool leaves = false;              ///< a walker leaves the core at random
    bool flat = false;                ///< x and y of no map depend on z
    bool sees_through = false;        ///< what is behind points shows
    bool wide = false;                ///< some table has more slots than half of a random number tells apart

    /// Nothing, and `why`, where points come from more than one core, or from surfaces that the kernel does
    /// not know. `seen_from_world` is put after each point's way to the world: its places are then as a
    /// picture sees them. `colour_of`: in place of tints; null: tints.
    static std::optional<FlatGame> of(const ChaosGame& game, const Affine& seen_from_world,
                                      const LabelColour& colour_of, std::string& why);

    void add_move(const Affine& map, const Paint& paint, const glm::uvec4& move_links);
    void add_choices(const AliasTables& tables);
    void add_colour(const Rgb& rgb) { colours.emplace_back(rgb.r, rgb.g, rgb.b, 0); }

    static constexpr std::uint32_t numbers_of_move = 4;

  private:
    class Writer;
};

} // namespace graftal
