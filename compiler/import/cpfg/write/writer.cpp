#include "compiler/import/cpfg/write/writer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/cpfg/block.h"
#include "compiler/import/cpfg/expression.h"
#include "compiler/import/cpfg/string.h"
#include "compiler/import/cpfg/write/variables.h"
#include "compiler/import/cpfg/write/words.h"
#include "compiler/import/foreign_text.h"
#include "compiler/support/number.h"

namespace graftal {

namespace {

constexpr std::size_t most_table_text = 64; ///< values in a table of a function that a line of text shows

/// The lines `word: value` of a file. A word may come again.
using Settings = std::vector<std::pair<std::string, std::string>>;

Settings settings_in(std::string_view text) {
    Settings settings;
    for (const TextLine& line : lines_of(text, 0, text.size())) {
        const std::size_t colon = line.text.find(':');
        if (colon == std::string_view::npos) continue;
        settings.emplace_back(trimmed(line.text.substr(0, colon)), trimmed(line.text.substr(colon + 1)));
    }
    return settings;
}

std::string setting(const Settings& settings, std::string_view word) {
    std::string value;
    for (const auto& [name, given] : settings)
        if (name == word) value = given;
    return value;
}

double number_in(const std::string& text, double otherwise) {
    const LeadingNumber number = leading_number(text);
    return number.length > 0 && std::isfinite(number.value) ? number.value : otherwise;
}

/// Whether a program measures in the plane of x and z, as it does unless it is told that it lives in space.
bool is_flat(const Settings& settings) {
    const std::string value = setting(settings, "3d case") + setting(settings, "3D case");
    return value != "on" && value != "yes";
}

/// Light sources of `chiba`: x y z intensity.
std::string sources_of(const Settings& settings) {
    std::string text;
    for (const auto& [name, value] : settings) {
        if (name != "source direction") continue;
        std::istringstream words(value);
        double x = 0, y = 0, z = 0, intensity = 0;
        if (words >> x >> y >> z >> intensity && intensity > 0)
            text += fmt::format(",  {}, {}, {}, {}", x, y, z, intensity);
    }
    return text;
}

/// The statement `environment ...` of ours that stands for a model's environment program; "" after the error
/// that it has no translation. `span`: of the query that asks it.
std::string environment_text(const std::string& file_name, CpfgNames& names, Span span) {
    const ForeignFile& file = names.file();
    const auto text_of = [&](const std::string& name) -> std::string_view {
        const std::optional<FileId> known = file.read_beside(name);
        return known ? file.sources.text(*known) : std::string_view();
    };
    std::istringstream command(setting(settings_in(text_of(file_name)), "executable"));
    std::string program, specification;
    command >> program;
    for (std::string word; command >> word;)
        specification = word;
    const Settings settings = settings_in(text_of(specification));
    if (program == "honda81") {
        const double radius = number_in(setting(settings, "radius"), 0);
        if (radius > 0)
            return fmt::format("environment crowd {}{}", radius, is_flat(settings) ? ", 0, 1, 0" : "");
    } else if (program == "ecosystem" && setting(settings, "vigor") != "on") {
        return fmt::format("environment rivals{}", is_flat(settings) ? " 0, 1, 0" : "");
    } else if (program == "chiba" && setting(settings, "estimate intersection area") == "on" &&
               (!sources_of(settings).empty() ||
                number_in(setting(settings, "lower to upper ratio"), 0.7) == 0)) {
        return fmt::format("environment shade {}{}", number_in(setting(settings, "transmittance"), 0.6),
                           sources_of(settings));
    }
    names.error(span, program.empty() ? "the model's environment program is not known"
                                      : fmt::format("the environment program '{}' has no translation",
                                                    comment_text(program)));
    return "";
}

class SystemWriter {
  public:
    SystemWriter(CpfgNames& names, LSystem& system, const ForeignModel& model, const std::string& environment)
        : names_(names), system_(system), model_(model), environment_(environment), words_(names, system),
          variables_(names, system) {}

    Translation write() {
        if (!names_.dialect()) share_probabilities();
        const Translation body = write_body();
        const std::string filter = filter_text();
        Translation out{"lsys", {}, {}};
        comments(out, system_.head_comments, "");
        const CpfgDialect* const dialect = names_.dialect();
        if (dialect) out.append(dialect->head);
        for (const char letter : words_.surfaces())
            out.line(fmt::format("use {} = \"{}\"", CpfgWords::surface_name(letter),
                                 names_.view().surfaces.at(letter).file));
        out.line(fmt::format("lsys {} {{", block_name(model_.name)), model_.span);
        if (!words_.declared().empty()) out.line("  modules " + declared_names());
        write_lets(out, body.text);
        for (const CpfgFunction& table : names_.tables())
            write_table(out, table);
        if (!dialect || dialect->angle_deg) out.line(fmt::format("  angle {}", names_.view().angle_deg));
        if (names_.view().width && !names_.view().width_in_pixels)
            out.line(fmt::format("  width {}", *names_.view().width));
        write_tropisms(out);
        if (dialect) out.append(dialect->settings);
        if (!system_.length.empty()) out.line("  steps " + system_.length, system_.length_span);
        if (!system_.seed.empty()) out.line("  seed " + system_.seed, system_.seed_span);
        if (words_.asks_environment()) write_environment(out);
        if (!filter.empty()) out.line(filter, system_.filter_span);
        if (has_contexts()) out.line("  precedence text");
        write_variables(out);
        comments(out, system_.axiom_comments, "  ");
        out.append(body);
        return out;
    }

  private:
    const std::vector<LSystemProduction>& productions(LSystemSection section) const {
        return system_.productions.at(section);
    }

    /// cpfg chooses by the shares of the probabilities in their sum.
    void share_probabilities() {
        for (auto& [section, productions] : system_.productions) {
            std::map<std::string, double> sums;
            const auto key = [](const LSystemProduction& p) {
                return p.predecessor.empty()
                           ? ""
                           : p.predecessor[0].symbol + std::to_string(p.predecessor[0].parameters.size());
            };
            const auto number = [&](const LSystemProduction& p) {
                const std::string text(trimmed(names_.expanded(p.probability, p.span, true)));
                const auto [value, length] = leading_number(text);
                return length > 0 && length == text.size() && std::isfinite(value) ? value : -1;
            };
            bool plain = true;
            for (const LSystemProduction& p : productions) {
                if (p.probability.empty()) continue;
                plain = plain && number(p) >= 0 && p.condition.empty() && p.left.empty() && p.right.empty();
                sums[key(p)] += number(p);
            }
            if (!plain) continue;
            for (LSystemProduction& p : productions)
                if (!p.probability.empty() && std::abs(sums[key(p)] - 1) > 1e-9 && sums[key(p)] > 0)
                    p.probability += fmt::format("/{}", sums[key(p)]);
        }
    }

    /// Writes the body, from the axiom to the end; the names that it uses are then known.
    Translation write_body() {
        Translation body{"lsys", {}, {}};
        const std::string axiom = words_.text_of(system_.axiom, system_.axiom_span);
        Translation rest{"lsys", {}, {}};
        for (const LSystemProduction& production : productions(LSystemSection::productions))
            write_production(rest, production, "  ", LSystemSection::productions);
        comments(rest, system_.tail_comments, "  ");
        write_section(rest, LSystemSection::decomposition, "decompose");
        write_section(rest, LSystemSection::homomorphism, "interpret");
        write_stand_ins(rest);
        if (words_.uses_cut()) { // in cpfg a step goes by before it cuts
            rest.line(fmt::format("  {} -> %", CpfgWords::cut_name));
            if (!names_.view().draws_past_cuts)
                rest.line(fmt::format("  interpret {} -> %", CpfgWords::cut_name));
        }
        if (names_.dialect()) rest.append(names_.dialect()->ending);
        rest.line("}");
        body.line("  axiom " + start_state() + axiom + remark_text(system_.axiom_remark), system_.axiom_span);
        body.append(rest);
        return body;
    }

    /// The turtle's state at the start, as modules.
    std::string start_state() const {
        if (names_.dialect()) return names_.dialect()->start;
        const CpfgView& view = names_.view();
        std::string text = view.has_colour ? fmt::format(";({})", view.colour) : "";
        if (view.elasticity != 0) text += fmt::format("T({})", view.elasticity);
        for (std::size_t i = 0; i < view.tropisms.size(); ++i)
            if (view.tropisms[i].elasticity != 0)
                text += fmt::format("@T({}, {})", i + 1, view.tropisms[i].elasticity);
        return text;
    }

    void write_stand_ins(Translation& out) {
        if (!words_.has_stand_ins()) return;
        out.line("  interpret {");
        std::istringstream lines(words_.stand_ins(system_.axiom_span));
        for (std::string line; std::getline(lines, line);)
            out.line("    " + line);
        out.line("  }");
    }

    void write_lets(Translation& out, const std::string& body) {
        std::string text = body + " " + system_.length + " " + system_.seed + " ";
        for (const auto* values : {&variables_.lets(), &variables_.variables()})
            for (const auto& [name, value] : *values)
                text += value + " ";
        for (const auto& [moment, block] : variables_.blocks())
            text += cpfg_block_text(block) + " ";
        for (const LSystemArray& array : system_.arrays)
            text += array.sizes + " " + array.values + " ";
        // Macros that are numbers may use others.
        const std::vector<CpfgMacro>& macros = names_.source().macros;
        for (auto macro = macros.rbegin(); macro != macros.rend(); ++macro)
            if (names_.lets().contains(macro->name) && uses(text, macro->name)) text += macro->body + " ";
        for (const CpfgMacro& macro : macros)
            if (names_.lets().contains(macro.name) && uses(text, macro.name))
                out.line(fmt::format("  let {} = {}", macro.name, macro.body), macro.span);
        for (const auto& [name, value] : variables_.lets())
            out.line(fmt::format("  let {} = {}", name, value), span_of(LSystemMoment::start));
    }

    Span span_of(LSystemMoment moment) const {
        const auto known = system_.block_spans.find(moment);
        return known == system_.block_spans.end() ? Span() : known->second;
    }

    void write_variables(Translation& out) {
        for (const LSystemArray& array : system_.arrays)
            out.line(fmt::format("  array {}{}{}{}", array.name, array.sizes,
                                 array.values.empty() ? "" : " = ", array.values),
                     array.span);
        for (const auto& [name, value] : variables_.variables())
            out.line(fmt::format("  variable {} = {}", name, value), span_of(LSystemMoment::start));
        constexpr std::pair<LSystemMoment, const char*> words[] = {{LSystemMoment::start, "start"},
                                                                   {LSystemMoment::start_each, "start each"},
                                                                   {LSystemMoment::end_each, "end each"},
                                                                   {LSystemMoment::end, "end"}};
        for (const auto& [moment, word] : words) {
            const auto block = variables_.blocks().find(moment);
            if (block != variables_.blocks().end() && !block->second.empty())
                out.line(fmt::format("  {} {}", word, cpfg_block_text(block->second)), span_of(moment));
        }
    }

    bool has_contexts() const {
        return std::ranges::any_of(productions(LSystemSection::productions), [](const LSystemProduction& p) {
            return !p.left.empty() || !p.right.empty();
        });
    }

    /// cpfg decomposes in steps only, and so not the axiom.
    bool decomposes_axiom() {
        const auto& decompositions = productions(LSystemSection::decomposition);
        return std::ranges::any_of(system_.axiom, [&](const LSystemModule& module) {
            return std::ranges::any_of(decompositions, [&](const LSystemProduction& production) {
                return production.predecessor[0].symbol == module.symbol;
            });
        });
    }

    void write_environment(Translation& out) {
        if (environment_.empty())
            names_.warn_once(system_.axiom_span,
                             "the model names no environment program: '?E' keeps the values that it has");
        else
            out.line("  " + environment_text(environment_, names_, system_.axiom_span));
    }

    /// `_` bends after each move, numbered tropisms before.
    void write_tropisms(Translation& out) {
        const CpfgView& view = names_.view();
        const bool old = words_.bends_of_old() || view.elasticity != 0;
        std::set<std::size_t> numbers = words_.tropisms();
        for (std::size_t i = 0; i < view.tropisms.size(); ++i)
            if (view.tropisms[i].elasticity != 0) numbers.insert(i + 1);
        if (old && !numbers.empty())
            names_.error(system_.axiom_span, "'_' together with numbered tropisms has no translation");
        if (old) {
            out.line("  tropism " + view.tropism_direction);
            out.line("  bending after moves");
        } else if (!numbers.empty()) {
            for (const CpfgTropism& tropism : view.tropisms)
                out.line(fmt::format("  {} {}{}", tropism.twists ? "torque" : "tropism", tropism.direction,
                                     tropism.angle_deg == 0 ? "" : fmt::format(", {}", tropism.angle_deg)));
            out.line("  bending before moves");
        }
    }

    static bool uses(std::string_view text, std::string_view name) {
        for (std::size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
            const bool begins = at == 0 || !is_cpfg_name(text[at - 1]);
            const std::size_t end = at + name.size();
            if (begins && (end == text.size() || !is_cpfg_name(text[end]))) return true;
        }
        return false;
    }

    static void comments(Translation& out, const std::vector<std::pair<std::string, Span>>& lines,
                         const char* indent) {
        for (const auto& [line, span] : lines)
            out.line(fmt::format("{}# {}", indent, line), span);
    }

    std::string declared_names() const {
        std::string names;
        for (const std::string& name : words_.declared())
            names += (names.empty() ? "" : " ") + name;
        return names;
    }

    void write_table(Translation& out, const CpfgFunction& table) {
        const std::vector<double>& values = table.values;
        std::string text = fmt::format("  table {} =", table.name);
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (i > 0) text += ",";
            if (i > 0 && i % most_table_text == 0) {
                out.line(text);
                text = "   ";
            }
            text += " " + shortest(values[i]);
        }
        out.line(text);
    }

    /// Where cpfg passes over '[' as over any ignored symbol, its right contexts see into branches and out of
    /// them.
    void check_brackets() {
        const bool listed = system_.filter_symbols.find('[') != std::string::npos;
        if (listed == (system_.filter == "consider")) return;
        for (const LSystemProduction& production : productions(LSystemSection::productions))
            if (!production.right.empty())
                names_.error(production.span,
                             "a right context that sees through ignored brackets has no translation");
    }

    /// A dialect lists its symbols with blanks between them.
    LSystemString filtered_modules() {
        if (!names_.dialect()) return read_cpfg_string(system_.filter_symbols, names_, system_.filter_span);
        LSystemString modules;
        std::istringstream words(system_.filter_symbols);
        for (std::string word; words >> word;)
            modules.emplace_back().symbol = word;
        return modules;
    }

    std::string filter_text() {
        if (system_.filter.empty()) return "";
        check_brackets();
        std::set<std::string> names;
        std::string text;
        for (const LSystemModule& module : filtered_modules()) {
            if (std::string_view("[]{}").find(module.symbol) != std::string_view::npos) continue;
            const std::string name = words_.name_of(module.symbol);
            if (names.insert(name).second) text += " " + name;
        }
        return text.empty() ? text : "  " + system_.filter + text;
    }

    void write_section(Translation& out, LSystemSection section, const char* word) {
        if (productions(section).empty()) return;
        out.line(fmt::format("  {} {{", word));
        for (const LSystemProduction& production : productions(section))
            write_production(out, production, "    ", section);
        out.line("  }");
    }

    void write_production(Translation& out, const LSystemProduction& production, const char* indent,
                          LSystemSection section) {
        comments(out, production.comments, indent);
        std::string text = indent;
        if (section == LSystemSection::productions && !production.left.empty())
            text += words_.formals(production.left) + " < ";
        text += words_.formals(production.predecessor);
        if (section == LSystemSection::productions && !production.right.empty())
            text += " > " + words_.formals(production.right);
        if (section != LSystemSection::productions && production.predecessor.size() > 1)
            names_.error(production.span,
                         "a decomposition or homomorphism of several modules has no translation");
        if (section == LSystemSection::decomposition &&
            (!production.left.empty() || !production.right.empty()))
            names_.error(production.span, "a context of a decomposition has no translation");
        text += cpfg_condition_text(production, variables_,
                                    section == LSystemSection::decomposition && decomposes_axiom());
        const bool drawn = section == LSystemSection::homomorphism && words_.depth_of(section) == 1;
        const std::string successor = drawn ? words_.drawn_text_of(production.successor, production.span)
                                            : words_.text_of(production.successor, production.span);
        text += " -> " + (successor.empty() ? "*" : successor);
        if (!production.probability.empty()) text += " : " + production.probability;
        out.line(text + remark_text(production.remark), production.span);
    }

    CpfgNames& names_;
    LSystem& system_;
    const ForeignModel& model_;
    const std::string& environment_; ///< the file of its program
    CpfgWords words_;
    CpfgVariables variables_;
};

} // namespace

Translation write_cpfg_system(CpfgNames& names, LSystem system, const ForeignModel& model,
                              const std::string& environment) {
    return SystemWriter(names, system, model, environment).write();
}

Translation write_dialect(const ForeignFile& file, LSystem system, const ForeignModel& model,
                          const CpfgDialect& dialect) {
    CpfgView view;
    view.angle_deg = dialect.angle_deg.value_or(view.angle_deg);
    const CpfgSource source;
    CpfgNames names(file, source, view, &dialect);
    return SystemWriter(names, system, model, "").write();
}

} // namespace graftal
