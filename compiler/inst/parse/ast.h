#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/graph/graph.h"
#include "compiler/inst/parse/scatter.h"
#include "compiler/syntax/expression.h"
#include "compiler/syntax/names.h"
#include "compiler/syntax/scene_statements.h"
#include "compiler/syntax/transform.h"

namespace graftal {

/// `tip` or `tip(n-1)` where an object is placed.
struct InstReference {
    std::string name;
    std::vector<Expression> arguments;
    std::string path; ///< of a file, in place of arguments: `mesh "leaf.obj"`
    Span path_span;
    Span span;
};

struct InstTint {
    std::vector<Expression> values; ///< r, g, b, alpha
    std::vector<Expression> until;  ///< the other end of a range, in a scatter; else empty
    Span span;
};

enum class InkChannel : std::uint8_t { hue, saturation, value, alpha };
inline constexpr std::size_t ink_channels = 4;

/// One change of the ink that is handed down: `ink: hsv(30, 1, 1)`, or a line of `ink { ... }`.
struct InstInkStep {
    enum class Kind : std::uint8_t {
        set,    ///< values: a colour, as parse_color() has it
        change, ///< values: degrees by which the hue turns, or a factor
        toward, ///< values: a target, and the share of the way to it
        upward, ///< values as `toward`: a hue that only grows on its way, past 360 degrees if it must
        downward
    };

    Kind kind = Kind::set;
    InkChannel channel = InkChannel::hue;
    std::vector<Expression> values;
    Span span;
};

/// `when test { ... } else { ... }`: the groups of the first block are there where the test is not 0.
struct InstTest {
    Expression test;
    Span span;
};

/// A test that a group depends on.
struct InstCondition {
    std::shared_ptr<const InstTest> test;
    bool wanted = true; ///< false after `else`
};

/// `repeat n { ... }` or `n * { ... }` makes n copies of the groups that follow it. Each copy applies the
/// lines of the block once more than the copy before; the first copy does not apply them.
struct InstRepeat {
    Expression count;
    std::vector<TransformLine> transforms;
    std::vector<InstTint> tints;
    std::optional<Expression> hue;
    std::vector<InstInkStep> ink;
    std::uint32_t size = 0; ///< tokens
    Span span;
};

/// A list that groups next to each other share: each of a million may stand in hundreds of blocks.
template<typename T> class InstSharedList {
  public:
    InstSharedList() = default;
    explicit InstSharedList(const std::vector<T>& list)
        : list_(list.empty() ? nullptr : std::make_shared<const std::vector<T>>(list)) {}

    std::size_t size() const { return list_ ? list_->size() : 0; }
    bool empty() const { return !list_; }
    const T* begin() const { return list_ ? list_->data() : nullptr; }
    const T* end() const { return begin() + size(); }
    /// Requires that it is not empty, or that there is a place of this number.
    const T& front() const { return list_->front(); }
    const T& operator[](std::size_t i) const { return (*list_)[i]; }

  private:
    std::shared_ptr<const std::vector<T>> list_; ///< null: an empty one
};

/// `union:`, `intersection:`, `difference:`, `instance:`, a bare name, `terminal:` or `scatter:`, and the
/// lines after it, which hold for each of its masters, the first line applied first.
struct InstGroup {
    bool terminal = false;
    std::optional<Expression> below; ///< of a terminal: the size from which down it is drawn
    /// The scatter that places the masters many times, or null. Few groups have one, and it is large.
    std::unique_ptr<InstScatter> scatter;
    std::vector<InstReference> masters; ///< one or more; one of a terminal
    std::vector<TransformLine> transforms;
    std::vector<InstTint> tints;
    std::optional<std::string> material;
    Span material_span;
    std::uint32_t size = 0;           ///< tokens without those of its repeats: the cost of evaluating it once
    std::optional<Expression> chance; ///< of each of the masters
    std::unique_ptr<Expression> hue;  ///< degrees by which the group turns the hues of its masters
    std::vector<InstInkStep> ink;
    InstSharedList<InstCondition> conditions;
    InstSharedList<std::shared_ptr<const InstRepeat>> repeats; ///< around the group, the outermost first
    Span span;
};

static_assert(sizeof(InstGroup) <= 512, "a model may have a million of them");

/// One parameter of a definition: a name, or a number that the argument must equal.
struct InstParameter {
    std::string name; ///< empty for a number
    double number = 0;
    Span span;

    bool is_number() const { return name.empty(); }
};

/// `canonical object tip(n) { ... }`; without `canonical` it is rendered.
struct InstDefinition {
    std::string name;
    bool rendered = false;
    std::vector<InstParameter> parameters;
    std::optional<Expression> weight; ///< among the definitions of the same name and parameters
    std::vector<InstGroup> groups;
    std::optional<Combination> combination; ///< of the groups, where one of them names it
    Span combination_span;
    std::vector<std::shared_ptr<const InstTest>> tests; ///< of all its conditions, those without groups too
    std::size_t size = 0;                               ///< tokens: what enumerating it once costs
    Span span;                                          ///< of the name with its parameters
};

/// A whole `.inst` file.
struct InstModule {
    std::vector<UseStatement> uses;
    std::vector<InstDefinition> definitions;
    std::vector<SceneStatement> scene;
    Span end;             ///< the place after the last token
    bool complete = true; ///< false if an error lost a definition: its name is then not known
};

} // namespace graftal
