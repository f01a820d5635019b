#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/points/collage.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/report.h"

namespace graftal {

namespace {

using Json = nlohmann::ordered_json;

Json collage_json(const Options& options, const Collage& collage) {
    return {{"target", options.points.target},
            {"model", options.operands.front()},
            {"target_pixels", collage.target_pixels},
            {"pixels", collage.pixels},
            {"pixel", collage.pixel},
            {"maps", collage.maps},
            {"condensations", collage.condensations},
            {"norm", collage.euclidean ? "euclidean" : "metric"},
            {"condition", collage.condition},
            {"contractivity", collage.contractivity},
            {"epsilon", collage.epsilon},
            {"bound", collage.bound},
            {"distance", collage.distance ? Json(*collage.distance) : Json(nullptr)}};
}

std::string collage_text(const Options& options, const Collage& collage) {
    const auto length = [&](double units) {
        return fmt::format("{:.4g} ({:.3g} pixels)", units, units / collage.pixel);
    };
    std::string text =
        fmt::format("target         {} of {} pixels: those {}\n", collage.target_pixels, collage.pixels,
                    criterion_text(options.points.criterion, collage.by_alpha));
    text += fmt::format("maps           {}", collage.maps);
    if (collage.condensations > 0) text += fmt::format(", and {} condensed", collage.condensations);
    text += fmt::format(
        "\ncontractivity  {:.6g}{}\n", collage.contractivity,
        collage.euclidean ? "" : fmt::format(", in a norm of condition {:.4g}", collage.condition));
    text +=
        fmt::format("epsilon        {}, distance of the target from its images\n", length(collage.epsilon));
    text += fmt::format("bound          {}, limit of the distance of the target from the attractor\n",
                        length(collage.bound));
    text += "measured       " +
            (collage.distance ? length(*collage.distance)
                              : std::string("-, because the attractor has too many parts")) +
            "\n";
    return text;
}

} // namespace

int run_collage(const Options& options) {
    CollageOptions collage_options;
    collage_options.compile = options.render.compile;
    collage_options.target = options.points.target;
    collage_options.criterion = options.points.criterion;
    Compilation compilation;
    CommandSession session(options, options.operands.front());
    const std::optional<Collage> collage = measure_collage(session, collage_options, compilation);
    const int status = conclude(options, compilation);
    if (!collage || status != exit_done) return status;
    if (!options.json) return print_output(collage_text(options, *collage));
    return print_output(collage_json(options, *collage).dump(2, ' ', false, Json::error_handler_t::replace) +
                        "\n");
}

} // namespace graftal
