#include "runtime/inverse/found/start_model.h"

#include <algorithm>

#include <fmt/format.h>

#include "compiler/chaos/ordinary_ifs.h"
#include "runtime/render/picture_session.h"

namespace graftal {

std::optional<std::vector<Affine>> starting_maps(const std::string& path, const StageOptions& options,
                                                 std::size_t most_maps, bool flat, Compilation& compilation) {
    std::vector<Affine> maps;
    if (path.empty()) return maps;
    PictureSession session(path);
    const std::shared_ptr<const AnalysedModel> model = session.analysed(options, compilation);
    if (!model) return std::nullopt;
    const std::optional<OrdinaryIfs> ifs = ordinary_ifs(model->graph, model->components);
    const auto fits = [flat](const Instance& map) { return !flat || is_flat(map.parent_from_child); };
    const Object& root = model->graph.objects[model->graph.root];
    if (!ifs || !ifs->condensation.empty() || !std::all_of(ifs->maps.begin(), ifs->maps.end(), fits)) {
        compilation.diagnostics
            .error(root.span, fmt::format("'{}' is not {} iterated function system, which the search could "
                                          "begin with",
                                          root.name, flat ? "a flat" : "an"))
            .with_hint(fmt::format("start with a .rifs of maps of {}, without 'follow' and 'condense'",
                                   flat ? "the plane" : "space"));
        return std::nullopt;
    }
    if (ifs->maps.size() > most_maps) {
        compilation.diagnostics
            .error(root.span, fmt::format("this system has {} maps, more than the {} that the search may use",
                                          ifs->maps.size(), most_maps))
            .with_hint(fmt::format("allow more: --maps {}", ifs->maps.size()));
        return std::nullopt;
    }
    for (const Instance& instance : ifs->maps)
        maps.push_back(instance.parent_from_child);
    return maps;
}

} // namespace graftal
