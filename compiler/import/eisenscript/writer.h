#pragma once

#include <set>
#include <string>

#include "compiler/import/eisenscript/analysis.h"
#include "compiler/import/importer.h"

namespace graftal::eisenscript {

/// The `.inst` of a script without errors.
class Writer {
  public:
    Writer(const ForeignFile& file, const Script& script);

    Translation write();

  private:
    /// A row of what `set` may say.
    void read_settings();
    void set(const Setting& setting);
    std::optional<double> number(const Setting& setting);
    std::vector<double> numbers(const Setting& setting, std::size_t count);
    void write_camera();
    void report_no_camera();
    void write_scene();
    void write_constants();
    void check_names();

    void write_rules();
    void write_rule(std::size_t index);
    void write_body(const Rule& rule, const Group& group, std::size_t index);
    void write_action(const Action& action, std::size_t from);
    void write_loops(const std::vector<Loop>& loops, const std::string& target, Span span);
    void write_mesh(const Action& action);
    bool holds_mesh(const Group& group) const;

    bool take(std::size_t& taken, std::size_t most, std::size_t count, Span span, std::string_view what);

    std::string reference(const std::string& name, const Group& from, std::optional<std::size_t> rule,
                          bool same_generation, double growth);
    std::string target_of(const Action& action, std::size_t from);
    std::string primitive(const Action& action);
    std::string triangle_object(const Token& token);
    std::string parameters(const Group& group) const;
    std::string counter_name(std::size_t rule) const;
    /// The lines of a loop's operators, in our order.
    std::string transforms(const std::vector<Operator>& operators);
    std::string inks(const std::vector<Operator>& operators);
    std::string expression(const Value& value) const;
    std::string free_name(std::string_view wanted);

    void comment(const std::string& words);
    void line(const std::string& words, Span origin = {});

    const ForeignFile& file_;
    const Script& script_;
    Limits limits_;
    std::optional<Analysis> analysis_;
    Translation out_{.extension = "inst"};
    int depth_ = 0; ///< of braces
    std::set<std::string> names_;
    std::set<std::string> constants_;                    ///< of Script that are written as `let`
    std::vector<std::string> object_names_;              ///< of groups
    std::vector<std::string> counter_names_;             ///< of rules
    std::map<std::string, std::string> primitive_names_; ///< as far as they are used
    std::map<std::string, std::vector<std::string>> primitive_lines_;
    struct Wrapper {
        std::string name;
        std::vector<Loop> loops;
        std::string target;
        Span span;
    };
    std::vector<Wrapper> wrappers_; ///< of the object being written
    std::size_t group_ = 0;         ///< being written
    std::size_t written_copies_ = 0, written_words_ = 0;
    bool stopped_ = false; ///< after the error that something is too much
    bool limited_ = false; ///< objects count generations
    bool sized_ = false;   ///< and sizes
    std::string pool_ = "randomhue";
    std::vector<std::string> pool_colours_; ///< of a list
    struct Camera {
        std::optional<std::vector<double>> translation, rotation, pivot;
        std::optional<double> scale, angle_deg;
    } camera_;
    std::optional<std::array<double, 3>> background_;
    struct Finish {
        std::optional<double> reflection, ambient, diffuse, specular;
    };
    std::map<std::string, Finish> finishes_; ///< by class; "" is the plain one
};

} // namespace graftal::eisenscript
