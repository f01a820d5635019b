#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/support/id_table.h"

namespace graftal {

/// A name for objects of a module: the letters and digits of the symbol.
std::string object_name(std::string_view symbol);

/// Makes objects of a graph of lists of instances, equal lists once. Lists are equal if they are the same up
/// to a uniform scale. Each number agrees to 1e-11 of the largest (of the translations) or of its own map's.
/// So the levels of a self-similar model become one object wherever nothing but their size differs.
class ObjectPool {
  public:
    /// `graph` must outlive this.
    explicit ObjectPool(Graph& graph);

    /// The instances that stand for the list in the lists of its users: the list itself if it is short. Else
    /// it is an instance of an object, which is named after `name` where it is new. Requires finite maps.
    /// `terminal` is drawn in place of the object where it is too small to see. Lists that differ by a
    /// rotation are equal too if each is given in the `frame` that it has in common with the others.
    std::vector<Instance> share(std::vector<Instance> instances, std::optional<Instance> terminal,
                                std::string_view name, Span span, const Mat3& frame = Mat3(1.0));

    /// About how many bytes of memory the objects take.
    std::size_t bytes() const { return bytes_; }

    /// Like `name`, with a number at the end if that name was given before.
    std::string unique_name(std::string_view name);

  private:
    bool worth_an_object(const std::vector<Instance>& instances) const;
    std::uint32_t find(const Object& object, std::uint64_t hash, std::size_t& looked) const;

    Graph& graph_;
    std::vector<ObjectId> shared_;
    std::size_t bytes_ = 0;
    IdTable ids_;
    std::unordered_map<std::string, unsigned> names_;
};

} // namespace graftal
