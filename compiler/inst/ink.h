#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/inst/hues.h"
#include "compiler/inst/parse/ast.h"
#include "compiler/lower/lowering.h"

namespace graftal {

/// A colour that is handed down: hue in degrees in [0, 360), then saturation, value and alpha in [0, 1], of
/// the colour as screens store it (sRGB).
struct Ink {
    std::array<double, ink_channels> channels{0, 0, 0, 1};

    double& operator[](InkChannel channel) { return channels[static_cast<std::size_t>(channel)]; }
    double operator[](InkChannel channel) const { return channels[static_cast<std::size_t>(channel)]; }
};

/// One step of a change, evaluated (InstInkStep).
struct InkStep {
    InstInkStep::Kind kind = InstInkStep::Kind::set;
    InkChannel channel = InkChannel::hue;
    double number = 0; ///< degrees, a factor or a target
    double share = 0;  ///< of the way to the target
    Ink ink;           ///< ink to set
};

/// The change of the ink on the way from an instance to its master.
class InkChange {
  public:
    /// More steps in one change are an error: each copy of a repeat may add some.
    static constexpr std::size_t most_steps = 256;

    bool empty() const { return steps_.empty(); }
    std::size_t size() const { return steps_.size(); }
    /// First this, then `later`. Steps that follow each other are joined where that is exact.
    void add(const InkChange& later);
    void add(const InkStep& step);
    /// Without an ink, only a set gives one.
    std::optional<Ink> apply(std::optional<Ink> ink) const;

  private:
    std::vector<InkStep> steps_;
};

/// The changes of the ink by the instances of an object.
struct ObjectInks {
    std::vector<InkChange> instances; ///< as many as the object has
    InkChange terminal;
};

/// The changes of the ink by object; other objects change nothing.
using InkTable = std::map<ObjectId, ObjectInks>;

/// Nothing after an error.
std::optional<InkChange> lower_ink(const std::vector<InstInkStep>& steps, const Environment& environment,
                                   Diagnostics& diagnostics, const ChanceDraws& draws);

/// Hands inks down to the primitives, which get them as tints that cover; where alpha is not 1, as
/// materials. If paths reach an object with different inks, the graph gets one copy of it for each. Inks are
/// told apart by channels in 65,536 steps. Once the graph has 100,000 objects, or twice as many as before, an
/// object takes the nearest ink that it has already, with a note. `hues` gets rows for the copies. An error,
/// at `place`: more objects than the options allow.
bool apply_inks(Graph& graph, const InkTable& inks, HueTable& hues, Span place, Lowering& lowering);

} // namespace graftal
