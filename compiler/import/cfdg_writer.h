#pragma once

#include <cmath>
#include <map>
#include <set>
#include <string>

#include "compiler/import/cfdg_ast.h"
#include "compiler/import/cfdg_expression.h"
#include "compiler/import/cfdg_recursion.h"
#include "compiler/import/importer.h"
#include "compiler/support/number.h"

namespace graftal::cfdg {

inline constexpr std::size_t longest_output = 8'000'000;

/// A number with as many decimals as `steps` has zeros, at most.
inline std::string rounded(double value, double steps = 1e6) {
    return shortest(std::round(steps * value) / steps);
}

/// The `.inst` of a grammar.
class Writer {
  public:
    Writer(const ForeignFile& file, const Grammar& grammar);

    Translation write();

  private:
    /// What a place in a rule knows.
    struct Place {
        std::size_t shape = 0;
        Scope scope;
        std::vector<std::string> parameters; ///< of the object being written
        std::size_t order = 0;               ///< of elements in their rule: later ones lie in front
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

    void check_definitions();
    bool read_symmetry(const Definition& definition);
    void write_scene();
    void write_camera();
    void write_start();
    void write_shape(std::size_t index);
    void write_rule(std::size_t index, const Rule& rule, const std::string& weight);
    void write_path(const Shape& shape, const std::string& name);
    void write_parts();
    void write_primitives();

    void write_elements(const Elements& elements, std::size_t first, Place& place);
    void write_element(const Element& element, Place& place);
    void write_loop(const Element& element, Place& place);
    void write_indexed_loop(const Element& element, Place& place);
    void write_condition(const Element& element, Place& place);
    void write_choice(const Element& element, Place& place);
    std::string part(const Elements& elements, std::size_t first, Place place, Span span,
                     const std::vector<std::string>& more = {});

    std::string reference(const Element& element, const Place* from, const Scope& scope);
    std::optional<Lines> lines_of(const Modification& modification, const Scope& scope, std::size_t order);
    std::optional<std::string> inks_of(const Modification& modification, const Scope& scope);
    std::string colour_step(const Adjustment& adjustment, const Scope& scope);
    std::optional<std::string> text(const Expr& expression, const Scope& scope);
    std::array<double, 3> colour_from(const Modification& modification, std::array<double, 3> hsv);

    std::string free_name(std::string_view wanted);
    std::string parameter_list(const std::vector<std::string>& names) const;
    void fail(Span span, std::string message, std::string hint = {});
    void comment(const std::string& words);
    void line(const std::string& words, Span origin = {});

    const ForeignFile& file_;
    const Grammar& grammar_;
    Expressions expressions_;
    Recursion recursion_;
    Translation out_{.extension = "inst"};
    int depth_ = 0;
    std::set<std::string> names_;
    std::vector<std::string> object_names_;         ///< by shape
    std::map<std::string, std::string> primitives_; ///< that are used
    Scope constants_;                               ///< of the file, as `let`s
    std::vector<Part> parts_;                       ///< to be written
    std::size_t written_parts_ = 0;
    int turns_ = 1; ///< of CF::Symmetry
    bool mirrors_ = false;
    int nested_ = 0; ///< adjustments within adjustments
};

} // namespace graftal::cfdg
