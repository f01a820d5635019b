#include "compiler/scene/backdrop.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/support/counter_random.h"

namespace graftal {

namespace {

constexpr int path_count = 400;
constexpr int path_length = 60; // by then half-covering tints leave 1e-18 of what is below

/// Whole numbers from 0 to n - 1; the same sequence everywhere.
class Rolls {
  public:
    std::size_t next(std::size_t n) { return static_cast<std::size_t>(random_(++count_) % n); }

  private:
    CounterRandom random_{0};
    std::uint64_t count_ = 0;
};

/// The colour at the end of a path. One that does not end is as bright as the terminal that stands there.
Rgb colour_of_path(const Graph& graph, Rolls& rolls) {
    PathTint tint;
    Rgb base = Material{}.rgb;
    ObjectId at = graph.root;
    for (int step = 0; step < 2 * path_length; ++step) {
        const Object& object = graph.objects[at];
        const Instance* next = step >= path_length && object.terminal ? &*object.terminal : nullptr;
        if (!next) {
            if (object.packed) {
                const std::size_t item = rolls.next(object.packed.item_count());
                if (const auto material = object.packed.material_of_item(item))
                    base = graph.materials[*material].rgb;
            }
            if (object.primitive || object.instances.empty()) break;
            next = &object.instances[rolls.next(object.instances.size())];
        }
        tint = tint * PathTint(next->tint);
        if (next->material) base = graph.materials[*next->material].rgb;
        at = next->master;
    }
    return tint.over(base);
}

/// Contrast of two colours to the eye, about 0 to 1: cube roots are near to even steps, and green counts
/// most for lightness.
double contrast(Rgb a, Rgb b) {
    const Rgb difference(std::cbrt(a.r) - std::cbrt(b.r), std::cbrt(a.g) - std::cbrt(b.g),
                         std::cbrt(a.b) - std::cbrt(b.b));
    return std::sqrt(glm::dot(Rgb(0.3, 0.55, 0.15), difference * difference));
}

/// Largest contrast of the less visible fifth of the colours.
double low_contrast(const std::vector<Rgb>& colours, Rgb background) {
    std::vector<double> contrasts;
    for (const Rgb& colour : colours)
        contrasts.push_back(contrast(colour, background));
    const auto fifth = contrasts.begin() + static_cast<std::ptrdiff_t>(contrasts.size() / 5);
    std::nth_element(contrasts.begin(), fifth, contrasts.end());
    return *fifth;
}

struct Shades {
    Rgb zenith, horizon;
};

/// Light backgrounds look better where both are possible.
constexpr double preference_for_light = 4;

Shades choose(const std::vector<Rgb>& colours, Shades light, Shades dark) {
    const double over_light = low_contrast(colours, 0.5 * (light.zenith + light.horizon));
    const double over_dark = low_contrast(colours, 0.5 * (dark.zenith + dark.horizon));
    return preference_for_light * over_light >= over_dark ? light : dark;
}

} // namespace

std::vector<Rgb> sample_colours(const Graph& graph) {
    Rolls rolls;
    std::vector<Rgb> colours;
    for (int i = 0; i < path_count; ++i)
        colours.push_back(colour_of_path(graph, rolls));
    return colours;
}

Sky automatic_sky(const std::vector<Rgb>& colours, const View& view, bool figure) {
    if (figure) {
        const Rgb paper(0.90, 0.89, 0.86), slate(0.012, 0.015, 0.022);
        const Shades plain = choose(colours, {paper, paper}, {slate, slate});
        return {.zenith = plain.zenith, .horizon = plain.horizon};
    }
    // Lit sides are about as bright as the plain colour, those in the shade a third of it.
    std::vector<Rgb> shaded;
    for (const Rgb& colour : colours)
        shaded.insert(shaded.end(), {0.85 * colour, 0.45 * colour});
    const Shades shades =
        choose(shaded, {{0.42, 0.56, 0.76}, {0.80, 0.86, 0.92}}, {{0.035, 0.06, 0.11}, {0.17, 0.22, 0.29}});
    Sky sky{.zenith = shades.zenith, .horizon = shades.horizon};
    const Camera& camera = view.camera;
    if (camera.orthographic) {
        sky.zenith = sky.horizon = 0.5 * (sky.zenith + sky.horizon);
    } else if (view.ground) {
        sky.to = 0.6;
    } else {
        span_picture(sky, view);
    }
    return sky;
}

void span_picture(Sky& sky, const View& view) {
    const double half = view.camera.angle_deg * std::numbers::pi / 360;
    const double rise = std::sin(std::atan(std::tan(half) * view.size.height / view.size.width));
    sky.axis = view.camera.up;
    sky.from = -rise;
    sky.to = rise;
}

} // namespace graftal
