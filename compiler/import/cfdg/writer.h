#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "compiler/import/cfdg/evaluate/expression.h"
#include "compiler/import/cfdg/parse/ast.h"
#include "compiler/import/cfdg/recursion.h"
#include "compiler/import/cfdg/scene.h"
#include "compiler/import/importer.h"

namespace graftal::cfdg {

inline constexpr std::size_t longest_output = 8'000'000;

/// The `.inst` of a grammar, with parameters as parameters. Constructs that `.inst` lacks are errors.
class Writer : private SceneWriter {
  public:
    Writer(const ForeignFile& file, const Grammar& grammar);

    Translation write();
    /// Whether the translation would show more than Context Free, which draws no shapes smaller than a pixel.
    bool shows_more() const;

  private:
    /// The context of a place in a rule.
    struct Place {
        std::size_t shape = 0;
        Scope scope;
        std::vector<std::string> parameters; ///< of the object being written
        double order = 0;                    ///< of elements in their rule: later ones lie in front
    };

    /// Elements that become an object of their own.
    struct Part {
        std::string name;
        const Elements* elements = nullptr;
        std::size_t first = 0; ///< of the elements
        Place place;
        Span span;
    };

    /// Lines of a modification.
    struct Lines {
        std::string moves;
        std::string inks;
    };

    void write_constants();
    void write_start_shape();
    void write_shape(std::size_t index);
    void write_rule(std::size_t index, const Rule& rule, const std::string& weight);
    void write_path(const Shape& shape, const std::string& name);
    void write_parts();

    void write_elements(const Elements& elements, std::size_t first, Place& place);
    void write_element(const Element& element, Place& place);
    void write_loop(const Element& element, Place& place);
    void write_indexed_loop(const Element& element, Place& place);
    void write_condition(const Element& element, Place& place);
    /// Whether a block lifts what it holds. An error where it resizes shapes and primitives together.
    bool lifts(const Modification& modification, std::initializer_list<const Elements*> held, Span place);
    /// Whether an element draws a shape of rules: no primitive, and no path.
    bool draws_rules(const Element& element) const;
    void look_into(const Elements& elements, bool& shapes, bool& others) const;
    void write_choice(const Element& element, Place& place);
    std::string part(const Elements& elements, std::size_t first, Place place, Span span,
                     const std::vector<std::string>& more = {});

    std::string reference(const Element& element, const Place* from, const Scope& scope);
    /// The height of a line over those before it.
    struct Height {
        double order = 0;    ///< in units of the order
        bool lifts = false;  ///< of shapes, which lie the higher the smaller they are; not of primitives
        bool block = false;  ///< of elements in a block: where it does not lift, its size changes no heights
        bool calls = false;  ///< of one shape of rules: it lies over the primitives of its rule
        double width = 0;    ///< of a turn of a loop: the units of all turns,
        std::string each_of; ///< and their number, where it is not known; "" else
    };
    std::optional<Lines> lines_of(const Modification& modification, const Scope& scope, const Height& height);
    /// The factor by which a line changes the size of its drawing.
    struct Size {
        double known = 1;    ///< in the mean, where chance decides
        std::string factors; ///< `*sqrt(...)` for each that depends on parameters
    };
    std::string height_text(const Height& height, const Size& size) const;

    void find_widths();
    double width_of(const Elements& elements, std::size_t shape) const;
    double width_of(const Element& element, std::size_t shape) const;
    std::optional<double> turns_of(const Element& loop) const;
    std::optional<std::string> inks_of(const Modification& modification, const Scope& scope);
    std::string colour_step(const Adjustment& adjustment, const Scope& scope);
    std::optional<std::string> text(const Expr& expression, const Scope& scope);

    std::string parameter_list(const std::vector<std::string>& names) const;

    Expressions expressions_;
    Recursion recursion_;
    std::vector<std::string> object_names_; ///< by shape
    Scope constants_;                       ///< of the file, as `let`s
    std::vector<Part> parts_;               ///< to be written
    std::size_t written_parts_ = 0;
    int nested_ = 0;             ///< adjustments within adjustments
    std::vector<double> widths_; ///< of each shape: how many heights its rule needs
    double widest_ = 1;
    double unit_ = 0; ///< of heights of an order
};

} // namespace graftal::cfdg
