#include "compiler/graph/text/emit_dot.h"

#include <map>
#include <string_view>

#include <fmt/format.h>

namespace graftal {

namespace {

/// A DOT string in quotes; backslashes would start escapes of its own.
std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
    return out + '"';
}

class DotWriter {
  public:
    DotWriter(const Graph& graph, const Components& components) : graph_(graph), components_(components) {}

    std::string run() && {
        out_ += "digraph graftal {\n  rankdir=TB;\n  node [fontname=\"Helvetica\", shape=ellipse];\n"
                "  edge [fontname=\"Helvetica\"];\n";
        // Clusters first, the component with the users before its masters.
        for (auto component = components_.members.size(); component-- > 0;)
            if (components_.cyclic[component]) write_cluster(component);
        for (ObjectId id = 0; id < graph_.objects.size(); ++id)
            if (!components_.cyclic[components_.component_of[id]]) write_node("  ", id);
        for (ObjectId id = 0; id < graph_.objects.size(); ++id)
            write_edges(id);
        out_ += "}\n";
        return std::move(out_);
    }

  private:
    void write_cluster(std::size_t component) {
        out_ += fmt::format("  subgraph cluster_{} {{\n    style=rounded;\n", component);
        for (const ObjectId member : components_.members[component])
            write_node("    ", member);
        out_ += "  }\n";
    }

    void write_node(const char* indent, ObjectId id) {
        const Object& object = graph_.objects[id];
        out_ += fmt::format("{}n{} [label={}", indent, id, quoted(object.name));
        if (object.primitive) out_ += ", shape=box";
        if (object.packed) out_ += fmt::format(", shape=box3d, xlabel=\"{} parts\"", object.packed.size());
        if (object.combination == Combination::intersect) out_ += ", xlabel=\"intersection\"";
        if (object.combination == Combination::subtract) out_ += ", xlabel=\"difference\"";
        if (id == graph_.root) out_ += ", peripheries=2";
        out_ += "];\n";
    }

    /// Edges in the order of the text, one a master; the terminal dashed.
    void write_edges(ObjectId id) {
        const Object& object = graph_.objects[id];
        std::map<ObjectId, std::size_t> counts;
        for (const Instance& instance : object.instances)
            ++counts[instance.master];
        for (const Instance& instance : object.instances) {
            std::size_t& count = counts[instance.master];
            if (count == 1) out_ += fmt::format("  n{} -> n{};\n", id, instance.master);
            if (count > 1) out_ += fmt::format("  n{} -> n{} [label=\"{}\"];\n", id, instance.master, count);
            count = 0; // written
        }
        if (object.terminal)
            out_ += fmt::format("  n{} -> n{} [style=dashed, label=\"terminal\"];\n", id,
                                object.terminal->master);
    }

    const Graph& graph_;
    const Components& components_;
    std::string out_;
};

} // namespace

std::string emit_dot(const Graph& graph, const Components& components) {
    return DotWriter(graph, components).run();
}

} // namespace graftal
