#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>

#include "compiler/graph/graph.h"

namespace graftal::testing {

/// A stream of choices: random numbers from a seed, or the bytes of a fuzzer (zeros once they have run out).
class Choices {
  public:
    explicit Choices(std::uint64_t seed) : random_(seed) {}
    explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes), from_bytes_(true) {}

    /// A number in [0, count). Requires count > 0.
    std::uint32_t below(std::uint32_t count);
    bool one_in(std::uint32_t count) { return below(count) == 0; }

  private:
    std::mt19937_64 random_;
    std::span<const std::uint8_t> bytes_;
    bool from_bytes_ = false;
};

struct RandomGraphOptions {
    std::uint32_t max_objects = 8;   ///< unions, before duplicates are planted
    std::uint32_t max_instances = 4; ///< of a union
    bool cycles = true;
    bool duplicates = true; ///< plants copies of objects under other names, in three graphs of four
    bool settings = true;   ///< random scene statements
    bool runs = false;      ///< some unions are runs (graph/run.h)
    /// Maps are powers of two times symmetries of the cube, moved by eighths, and contract: products are
    /// exact.
    bool exact = false;
    bool mirrored = false; ///< some unions are their own mirror images
    bool combined = false; ///< of solids; some objects are intersections and differences
    double huge = 1e200;   ///< the largest number in a transform; models have none beyond 1e100
};

/// A graph that verify() accepts: unions in every relation, shared and nested masters, cycles through one
/// object and several, terminals, tints, materials, and transforms that are affine in every way (mirrored,
/// sheared, flattened, far away, tiny, with zeros of both signs). Its cycles need not contract. Objects may
/// be unreachable.
Graph random_graph(Choices& choices, const RandomGraphOptions& options = {});

/// Adds a copy of every union under another name, with the instances in another order, and lets references
/// lead into either copy at random. Means the same; merge_equivalent must undo it.
void plant_duplicates(Graph& graph, Choices& choices);

/// The same graph with its objects in another order.
Graph permuted(const Graph& graph, Choices& choices);

} // namespace graftal::testing
