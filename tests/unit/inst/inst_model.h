#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/languages/lower.h"

namespace graftal {

/// A text of `.inst`, lowered.
struct InstModel {
    SourceMap sources;
    Diagnostics diagnostics;
    std::optional<Graph> graph; ///< nothing after errors

    explicit InstModel(std::string text, const LowerOptions& options = {}) {
        graph = lower_text("m.inst", std::move(text), options, sources, diagnostics).graph;
    }

    std::string said() const { return diagnostics.render(sources); }

    // Those below require that there is a graph.

    const Object& root() const { return graph->objects[graph->root]; }
    const Object& master(const Instance& instance) const { return graph->objects[instance.master]; }
    const Object& object(std::string_view name) const {
        for (const Object& object : graph->objects)
            if (object.name == name) return object;
        throw std::runtime_error("no object " + std::string(name));
    }
    std::vector<std::string> names() const {
        std::vector<std::string> names;
        for (const Object& object : graph->objects)
            names.push_back(object.name);
        return names;
    }
    std::vector<std::string> masters(std::string_view name) const {
        std::vector<std::string> masters;
        for (const Instance& instance : object(name).instances)
            masters.push_back(master(instance).name);
        return masters;
    }
    Affine map(std::string_view name, std::size_t i = 0) const {
        return object(name).instances[i].parent_from_child;
    }
};

} // namespace graftal
