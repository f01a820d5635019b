#include "compiler/import/cpfg_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "compiler/import/cpfg_string.h"
#include "compiler/import/cpfg_words.h"
#include "compiler/import/importers.h"

namespace graftal {

namespace {

constexpr std::size_t most_table_text = 64; ///< values in a table of a function that a line of text shows

class SystemWriter {
  public:
    SystemWriter(CpfgNames& names, CpfgSystem& system, const ForeignModel& model)
        : names_(names), system_(system), model_(model), words_(names, system) {}

    Translation write() {
        share_probabilities();
        Translation out{"lsys", {}, {}};
        comments(out, system_.head_comments, "");
        const std::string body = strings_first();
        for (const char letter : words_.surfaces())
            out.line(fmt::format("use {} = \"{}\"", CpfgWords::surface_name(letter),
                                 names_.view().surfaces.at(letter).file));
        out.line(fmt::format("lsys {} {{", block_name(model_.name)), model_.span);
        if (!words_.declared().empty()) out.line("  modules " + declared_names());
        for (const CpfgMacro& macro : names_.source().macros)
            if (names_.lets().contains(macro.name) && uses(body, macro.name))
                out.line(fmt::format("  let {} = {}", macro.name, macro.body), macro.span);
        for (const auto& [name, value] : system_.globals)
            out.line(fmt::format("  let {} = {}", name, value), system_.globals_span);
        for (const std::size_t place : names_.used_tables())
            write_table(out, place);
        out.line(fmt::format("  angle {}", names_.view().angle_deg));
        if (names_.view().width && !names_.view().width_in_pixels)
            out.line(fmt::format("  width {}", *names_.view().width));
        if (!system_.length.empty()) out.line("  steps " + system_.length, system_.length_span);
        if (!system_.seed.empty()) out.line("  seed " + system_.seed, system_.seed_span);
        write_filter(out);
        comments(out, system_.axiom_comments, "  ");
        const std::string colour = names_.view().has_colour ? fmt::format(";({})", names_.view().colour) : "";
        out.line("  axiom " + colour + words_.text_of(system_.axiom, system_.axiom_span), system_.axiom_span);
        for (const CpfgProduction& production : productions(CpfgSection::productions))
            write_production(out, production, "  ", CpfgSection::productions);
        write_section(out, CpfgSection::decomposition, "decompose");
        write_section(out, CpfgSection::homomorphism, "interpret");
        out.line("}");
        return out;
    }

  private:
    std::vector<CpfgProduction>& productions(CpfgSection section) { return system_.productions[section]; }

    /// cpfg chooses by the shares of the probabilities in their sum.
    void share_probabilities() {
        for (auto& [section, productions] : system_.productions) {
            std::map<std::string, double> sums;
            const auto key = [](const CpfgProduction& p) {
                return p.predecessor.empty()
                           ? ""
                           : p.predecessor[0].symbol + std::to_string(p.predecessor[0].parameters.size());
            };
            const auto number = [](const std::string& text) {
                char* end = nullptr;
                const double value = std::strtod(text.c_str(), &end);
                return end != text.c_str() && *end == '\0' && std::isfinite(value) ? value : -1;
            };
            bool plain = true;
            for (const CpfgProduction& p : productions) {
                if (p.probability.empty()) continue;
                plain =
                    plain && number(p.probability) >= 0 && p.condition.empty() && !p.has_left && !p.has_right;
                sums[key(p)] += number(p.probability);
            }
            if (!plain) continue;
            for (CpfgProduction& p : productions)
                if (!p.probability.empty() && std::abs(sums[key(p)] - 1) > 1e-9 && sums[key(p)] > 0)
                    p.probability += fmt::format("/{}", sums[key(p)]);
        }
    }

    /// All strings once, to learn which names they use.
    std::string strings_first() {
        Translation scratch{"lsys", {}, {}};
        scratch.line(words_.text_of(system_.axiom, system_.axiom_span));
        scratch.line(system_.length + " " + system_.seed);
        for (const auto& [name, value] : system_.globals)
            scratch.line(value);
        for (const auto section :
             {CpfgSection::productions, CpfgSection::decomposition, CpfgSection::homomorphism})
            for (const CpfgProduction& production : productions(section))
                write_production(scratch, production, "", section);
        // Macros that are numbers may use others.
        std::string text = scratch.text;
        for (auto macro = names_.source().macros.rbegin(); macro != names_.source().macros.rend(); ++macro)
            if (names_.lets().contains(macro->name) && uses(text, macro->name)) text += macro->body + " ";
        return text;
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

    void write_table(Translation& out, std::size_t place) {
        const std::vector<double>& values = names_.view().functions[place].values;
        std::string text = fmt::format("  table {} =", names_.table_name(place));
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (i > 0) text += ",";
            if (i > 0 && i % most_table_text == 0) {
                out.line(text);
                text = "   ";
            }
            text += fmt::format(" {:.6g}", values[i]);
        }
        out.line(text);
    }

    void write_filter(Translation& out) {
        if (system_.filter.empty()) return;
        std::set<std::string> names;
        std::string text;
        for (const CpfgModule& module :
             read_cpfg_string(system_.filter_symbols, names_, system_.filter_span)) {
            if (std::string_view("[]{}").find(module.symbol) != std::string_view::npos) continue;
            const std::string name = words_.name_of(module.symbol);
            if (names.insert(name).second) text += " " + name;
        }
        if (!text.empty()) out.line(fmt::format("  {}{}", system_.filter, text), system_.filter_span);
    }

    void write_section(Translation& out, CpfgSection section, const char* word) {
        if (productions(section).empty()) return;
        out.line(fmt::format("  {} {{", word));
        for (const CpfgProduction& production : productions(section))
            write_production(out, production, "    ", section);
        out.line("  }");
    }

    void write_production(Translation& out, const CpfgProduction& production, const char* indent,
                          CpfgSection section) {
        comments(out, production.comments, indent);
        std::string text = indent;
        if (section == CpfgSection::productions && production.has_left && !production.left.empty())
            text += words_.formals(production.left) + " < ";
        text += words_.formals(production.predecessor);
        if (section == CpfgSection::productions && production.has_right && !production.right.empty())
            text += " > " + words_.formals(production.right);
        if (section != CpfgSection::productions && (!production.left.empty() || !production.right.empty()))
            names_.error(production.span, "a context of a decomposition or homomorphism has no translation");
        if (!production.condition.empty() || !production.locals.empty())
            text += " : " + (production.condition.empty() ? "1" : production.condition);
        bool first = true;
        for (const auto& [name, value] : production.locals) {
            text += fmt::format("{}{} = {}", first ? " with " : ", ", name, value);
            first = false;
        }
        const bool raw = section == CpfgSection::homomorphism && words_.depth_of(section) == 1;
        const std::string successor = words_.text_of(production.successor, production.span, raw);
        text += " -> " + (successor.empty() ? "*" : successor);
        if (!production.probability.empty()) text += " : " + production.probability;
        out.line(text, production.span);
    }

    CpfgNames& names_;
    CpfgSystem& system_;
    const ForeignModel& model_;
    CpfgWords words_;
};

} // namespace

Translation write_cpfg_system(CpfgNames& names, CpfgSystem system, const ForeignModel& model) {
    return SystemWriter(names, system, model).write();
}

} // namespace graftal
