#include "compiler/import/cpfg.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "compiler/import/cpfg_expression.h"
#include "compiler/import/cpfg_source.h"
#include "compiler/import/cpfg_view.h"
#include "compiler/import/foreign_text.h"
#include "compiler/import/importers.h"
#include "compiler/support/small_letters.h"

namespace graftal {

namespace {

constexpr std::size_t most_table_text = 64; ///< values in a table of a function that a line of text shows

bool is_cpfg_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

struct CpfgModule {
    std::string symbol; ///< "F", "@Gs", "~l"
    std::vector<std::string> parameters;
    bool has_parentheses = false;
};

using CpfgString = std::vector<CpfgModule>;

enum class CpfgSection { productions, decomposition, homomorphism };

struct CpfgProduction {
    CpfgString left, predecessor, right;
    bool has_left = false, has_right = false;
    std::string condition; ///< "" for none
    std::vector<std::pair<std::string, std::string>> locals;
    CpfgString successor;
    std::string probability;
    Span span;
    std::vector<std::pair<std::string, Span>> comments;
};

class CpfgTranslator {
  public:
    CpfgTranslator(const ForeignFile& file, const ForeignModel& model, const CpfgSource& source)
        : file_(file), model_(model), source_(source), view_(read_cpfg_view(file)) {}

    std::optional<Translation> translate() {
        const std::size_t errors = file_.diagnostics.error_count();
        find_lets();
        for (const CpfgStatement& statement : source_.statements) {
            if (ended_ || file_.diagnostics.full()) break;
            read(statement);
        }
        if (axiom_.empty() && file_.diagnostics.error_count() == errors)
            error(Span(), "the model has no axiom");
        if (file_.diagnostics.error_count() > errors) return std::nullopt;
        Translation out = write();
        if (file_.diagnostics.error_count() > errors) return std::nullopt;
        return out;
    }

  private:
    // ------------------------------------------------------------------------------------------- reading

    void error(Span span, const std::string& message) { file_.diagnostics.error(span, message); }
    void warn_once(Span span, const std::string& message) {
        if (warned_.insert(message).second) file_.diagnostics.warning(span, message);
    }

    static Span span_of(const CpfgStatement& statement, const ForeignFile& file) {
        const std::size_t first = statement.text.find_first_not_of(' ');
        const std::size_t last = statement.text.find_last_not_of(' ');
        const std::uint32_t begin = statement.places[first], end = statement.places[last];
        return file.span(begin, end < begin ? begin : end + 1);
    }

    /// Macros that are numbers stay names.
    void find_lets() {
        for (const CpfgMacro& macro : source_.macros) {
            if (macro.parameters || macro.body.empty()) continue;
            std::string_view body = macro.body;
            bool number = true;
            for (std::size_t i = 0; i < body.size() && number;) {
                if (std::isdigit(static_cast<unsigned char>(body[i])) || body[i] == '.') {
                    while (i < body.size() && (is_cpfg_name(body[i]) || body[i] == '.'))
                        ++i;
                } else if (is_cpfg_name(body[i])) {
                    std::size_t end = i;
                    while (end < body.size() && is_cpfg_name(body[end]))
                        ++end;
                    const std::string name(body.substr(i, end - i));
                    constexpr std::string_view known[] = {"sin", "cos", "tan", "sqrt", "exp", "log"};
                    number = lets_.contains(name) || std::ranges::find(known, name) != std::end(known);
                    i = end;
                } else {
                    number = std::string_view("+-*/^() ").find(body[i]) != std::string_view::npos;
                    ++i;
                }
            }
            const bool balanced = std::ranges::count(body, '(') == std::ranges::count(body, ')');
            const bool ends = std::isalnum(static_cast<unsigned char>(body.back())) || body.back() == ')' ||
                              body.back() == '.';
            if (number && balanced && ends) lets_.insert(macro.name);
        }
    }

    std::string expanded(std::string_view text, Span span, bool in_string) {
        const auto chosen = [&](const CpfgMacro& macro) { return in_string || !lets_.contains(macro.name); };
        std::optional<std::string> out = expand_cpfg_macros(text, source_.macros, chosen);
        if (!out) error(span, "the macros here do not end, or make too long a text");
        return out.value_or("");
    }

    std::string expression(std::string_view text, Span span) {
        const std::function<std::optional<std::string>(std::string_view)> table_of =
            [&](std::string_view id) { return table_named(id, span); };
        const std::function<void(const std::string&)> complain = [&](const std::string& message) {
            error(span, message);
        };
        return translated_cpfg_expression(expanded(text, span, false), table_of, complain);
    }

    std::optional<std::string> table_named(std::string_view id, Span span) {
        const std::string number = expanded(id, span, true);
        const auto place = static_cast<std::size_t>(std::strtoul(number.substr(0, 9).c_str(), nullptr, 10));
        if (place == 0 || place > view_.functions.size() ||
            trimmed(number).find_first_not_of("0123456789") != std::string_view::npos) {
            error(span, fmt::format("there is no function {} among those that the view file names",
                                    comment_text(number)));
            return std::nullopt;
        }
        used_tables_.insert(place - 1);
        return table_name(place - 1);
    }

    std::string table_name(std::size_t place) const { return view_.functions[place].name + "_of"; }

    void read(const CpfgStatement& statement) {
        const Span span = span_of(statement, file_);
        const std::string_view text = trimmed(statement.text);
        const std::string small = in_small_letters(text.substr(0, 24));
        const auto value = [&] { return trimmed(text.substr(std::min(text.find(':') + 1, text.size()))); };
        const auto is = [&](std::string_view word) { return small.starts_with(word); };
        if (is("lsystem:")) {
            if (++systems_ > 1) {
                error(span, "sub-L-systems have no translation: a model has one L-system");
                ended_ = true;
            }
            head_comments_ = statement.comments;
        } else if (is("seed:") && section_ == CpfgSection::productions) {
            seed_ = expression(value(), span);
            seed_span_ = span;
            stochastic_ = true;
        } else if (is("seed:")) {
            warn_once(span, "a seed of the homomorphism is left out: one seed decides all");
        } else if (is("derivation length:") || is("derivationlength:")) {
            length_ = expression(value(), span);
            length_span_ = span;
        } else if (is("maximum depth:")) {
            depth_[section_] = expanded(value(), span, true);
        } else if (is("ignore:") || is("consider:")) {
            filter_ = is("ignore:") ? "ignore" : "consider";
            filter_symbols_ = value();
            filter_span_ = span;
        } else if (is("axiom:")) {
            axiom_ = string_of(value(), span);
            axiom_span_ = span;
            axiom_comments_ = statement.comments;
        } else if (is("start:")) {
            take_start(value(), span);
        } else if (is("starteach:") || is("start each:") || is("endeach:") || is("end each:") || is("end:")) {
            take_blocks(value(), span);
        } else if (is("define:")) {
            error(span, "arrays and other definitions have no translation");
        } else if (is("ring ")) {
            error(span, "a ring L-system has no translation");
        } else if (is("homomorphism")) {
            section_ = CpfgSection::homomorphism;
        } else if (is("decomposition")) {
            section_ = CpfgSection::decomposition;
        } else if (is("endlsystem")) {
            ended_ = false;
        } else if (statement.text.find("-->") != std::string::npos) {
            add_production(statement, span);
        } else if (statement.text.find("-o>") != std::string::npos) {
            error(span, "productions of objects (-o>) have no translation");
        } else {
            error(span, "this is no statement of cpfg");
        }
    }

    /// `{ a = 1; b = a/2; }`: names and values; false after an error. What prints is left out.
    bool assignments(std::string_view block, Span span,
                     std::vector<std::pair<std::string, std::string>>& out) {
        block = trimmed(block);
        if (block.starts_with('{')) block.remove_prefix(1);
        if (block.ends_with('}')) block.remove_suffix(1);
        while (!trimmed(block).empty()) {
            const std::size_t end = std::min(find_outside(block, ";"), block.size());
            const std::string_view statement = trimmed(block.substr(0, end));
            block.remove_prefix(std::min(end + 1, block.size()));
            if (statement.empty()) continue;
            std::size_t name_end = 0;
            while (name_end < statement.size() && is_cpfg_name(statement[name_end]))
                ++name_end;
            const std::string name(statement.substr(0, name_end));
            const std::string_view rest = trimmed(statement.substr(name_end));
            if (name == "printf" || name == "fprintf") {
                warn_once(span, "what the model prints is left out");
            } else if (name == "srand") {
                warn_once(span, "srand() is left out: one seed decides all");
            } else if (!name.empty() && rest.starts_with('=') && !rest.starts_with("==")) {
                out.emplace_back(name, expression(rest.substr(1), span));
            } else {
                error(span, fmt::format("'{}' has no translation here",
                                        name.empty() ? comment_text(statement.substr(0, 20)) : name));
                return false;
            }
        }
        return true;
    }

    void take_start(std::string_view block, Span span) {
        std::vector<std::pair<std::string, std::string>> values;
        if (!assignments(block, span, values)) return;
        for (auto& [name, value] : values) {
            if (!globals_.insert(name).second)
                error(span, fmt::format("'{}' changes, which has no translation", name));
            globals_values_.emplace_back(name, value);
        }
        globals_span_ = span;
    }

    /// Blocks of each step and of the end: what they say may not change anything.
    void take_blocks(std::string_view block, Span span) {
        std::vector<std::pair<std::string, std::string>> values;
        if (assignments(block, span, values) && !values.empty())
            error(span, "variables that change from step to step have no translation");
    }

    // ------------------------------------------------------------------------------------------- strings

    /// The modules of a string, after its macros.
    CpfgString string_of(std::string_view given, Span span) {
        const std::string text = expanded_string(given, span);
        CpfgString string;
        for (std::size_t i = 0; i < text.size();) {
            const char c = text[i];
            if (c == ' ' || c == '\t') {
                ++i;
                continue;
            }
            CpfgModule module;
            module.symbol = c;
            ++i;
            if ((c == '@' || c == '~') && i < text.size()) module.symbol += text[i++];
            skip_blanks(text, i);
            take_parameters(text, i, module, span);
            constexpr std::string_view longer = "GPTDbm";
            if (c == '@' && module.symbol.size() == 2 &&
                longer.find(module.symbol[1]) != std::string_view::npos && !module.has_parentheses &&
                i < text.size() && std::isalpha(static_cast<unsigned char>(text[i]))) {
                module.symbol += text[i++];
                skip_blanks(text, i);
                take_parameters(text, i, module, span);
            }
            string.push_back(std::move(module));
        }
        return string;
    }

    static void skip_blanks(std::string_view text, std::size_t& i) {
        std::size_t next = i;
        while (next < text.size() && text[next] == ' ')
            ++next;
        if (next < text.size() && text[next] == '(') i = next;
    }

    void take_parameters(std::string_view text, std::size_t& i, CpfgModule& module, Span span) {
        if (i >= text.size() || text[i] != '(') return;
        module.has_parentheses = true;
        const std::size_t begin = ++i;
        int depth = 1;
        for (; i < text.size() && depth > 0; ++i)
            depth += (text[i] == '(') - (text[i] == ')');
        if (depth > 0) {
            error(span, fmt::format("the '(' after '{}' is not closed", module.symbol));
            return;
        }
        const std::string_view inside = text.substr(begin, i - begin - 1);
        for (std::size_t from = 0; from <= inside.size() && !trimmed(inside).empty();) {
            const std::size_t comma = std::min(find_outside(inside, ",", from), inside.size());
            module.parameters.emplace_back(trimmed(inside.substr(from, comma - from)));
            from = comma + 1;
        }
    }

    /// All macros outside of parentheses; inside them those that are no numbers.
    std::string expanded_string(std::string_view text, Span span) {
        std::string out;
        for (std::size_t i = 0; i < text.size();) {
            const std::size_t open = std::min(text.find('(', i), text.size());
            std::size_t close = open;
            int depth = 0;
            do {
                if (close >= text.size()) break;
                depth += (text[close] == '(') - (text[close] == ')');
                ++close;
            } while (depth > 0);
            // A macro with arguments takes its parentheses along.
            std::size_t name = open;
            while (name > i && is_cpfg_name(text[name - 1]))
                --name;
            const auto macro =
                std::ranges::find(source_.macros, text.substr(name, open - name), &CpfgMacro::name);
            if (macro != source_.macros.end() && macro->parameters) {
                out += expanded(text.substr(i, name - i), span, true);
                out += expanded(text.substr(name, close - name), span, true);
            } else {
                out += expanded(text.substr(i, open - i), span, true);
                out += expanded(text.substr(open, close - open), span, false);
            }
            i = close;
        }
        return out;
    }

    // ---------------------------------------------------------------------------------------- productions

    void add_production(const CpfgStatement& statement, Span span) {
        CpfgProduction production;
        production.span = span;
        production.comments = statement.comments;
        const std::string_view text = trimmed(statement.text);
        const std::size_t arrow = text.find("-->");
        const std::string_view head = text.substr(0, arrow), tail = text.substr(arrow + 3);
        const std::size_t colon = find_outside(head, ":");
        read_left_side(head.substr(0, colon), production);
        if (colon != std::string_view::npos && !read_condition(head.substr(colon + 1), production)) return;
        const std::size_t chance = find_outside(tail, ":");
        if (trimmed(tail.substr(0, chance)) != "*")
            production.successor = string_of(tail.substr(0, chance), span);
        if (chance != std::string_view::npos) {
            if (stochastic_)
                production.probability = expression(tail.substr(chance + 1), span);
            else
                warn_once(span, "without a seed cpfg passes over probabilities: the first production counts");
        }
        productions_[section_].push_back(std::move(production));
    }

    void read_left_side(std::string_view text, CpfgProduction& production) {
        const std::size_t less = find_outside(text, "<");
        if (less != std::string_view::npos) {
            production.has_left = true;
            if (trimmed(text.substr(0, less)) != "*")
                production.left = string_of(text.substr(0, less), production.span);
            text.remove_prefix(less + 1);
        }
        const std::size_t more = find_outside(text, ">");
        if (more != std::string_view::npos) {
            production.has_right = true;
            const std::string_view right = trimmed(text.substr(more + 1));
            if (right != "*") production.right = string_of(right, production.span);
        }
        production.predecessor = string_of(text.substr(0, more), production.span);
        // It says that the branch may go on, which is so without it.
        std::erase_if(production.right, [](const CpfgModule& module) { return module.symbol == "="; });
        if (production.predecessor.size() != 1)
            error(production.span,
                  fmt::format("a production for {} modules has no translation: ours rewrite one",
                              production.predecessor.size()));
    }

    /// `{ before } condition { after }`
    bool read_condition(std::string_view text, CpfgProduction& production) {
        text = trimmed(text);
        if (text.starts_with('{')) {
            const std::size_t end = std::min(text.find('}') + 1, text.size());
            if (!add_locals(text.substr(0, end), production)) return false;
            text = trimmed(text.substr(end));
        }
        const std::size_t open = std::min(text.find('{'), text.size());
        const std::string_view condition = trimmed(text.substr(0, open));
        if (condition != "*" && !condition.empty())
            production.condition = expression(condition, production.span);
        return open == text.size() || add_locals(text.substr(open), production);
    }

    bool add_locals(std::string_view block, CpfgProduction& production) {
        std::vector<std::pair<std::string, std::string>> values;
        if (!assignments(block, production.span, values)) return false;
        for (auto& [name, value] : values) {
            if (globals_.contains(name)) {
                error(production.span,
                      fmt::format("'{}' is a variable of the model: that a production changes it has no "
                                  "translation",
                                  name));
                return false;
            }
            production.locals.emplace_back(name, value);
        }
        return true;
    }

    // -------------------------------------------------------------------------------------------- writing

    /// cpfg chooses by the shares of the probabilities in their sum.
    void share_probabilities() {
        for (auto& [section, productions] : productions_) {
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

    Translation write() {
        share_probabilities();
        Translation out{"lsys", {}, {}};
        comments(out, head_comments_, "");
        const std::string body = strings_first();
        for (const char letter : used_surfaces_)
            out.line(fmt::format("use {} = \"{}\"", surface_name(letter), view_.surfaces[letter].file));
        out.line(fmt::format("lsys {} {{", block_name(model_.name)), model_.span);
        if (!declared_.empty()) out.line("  modules " + declared());
        for (const CpfgMacro& macro : source_.macros)
            if (lets_.contains(macro.name) && uses(body, macro.name))
                out.line(fmt::format("  let {} = {}", macro.name, macro.body), macro.span);
        for (const auto& [name, value] : globals_values_)
            out.line(fmt::format("  let {} = {}", name, value), globals_span_);
        for (const std::size_t place : used_tables_)
            write_table(out, place);
        out.line(fmt::format("  angle {}", view_.angle_deg));
        if (view_.width && !view_.width_in_pixels) out.line(fmt::format("  width {}", *view_.width));
        if (!length_.empty()) out.line("  steps " + length_, length_span_);
        if (!seed_.empty()) out.line("  seed " + seed_, seed_span_);
        write_filter(out);
        comments(out, axiom_comments_, "  ");
        const std::string colour = view_.has_colour ? fmt::format(";({})", view_.colour) : "";
        out.line("  axiom " + colour + text_of(axiom_, axiom_span_), axiom_span_);
        for (const CpfgProduction& production : productions_[CpfgSection::productions])
            write_production(out, production, "  ", CpfgSection::productions);
        write_section(out, CpfgSection::decomposition, "decompose");
        write_section(out, CpfgSection::homomorphism, "interpret");
        out.line("}");
        return out;
    }

    /// All strings once, to learn which names they use.
    std::string strings_first() {
        Translation scratch{"lsys", {}, {}};
        scratch.line(text_of(axiom_, axiom_span_));
        scratch.line(length_ + " " + seed_);
        for (const auto& [name, value] : globals_values_)
            scratch.line(value);
        for (const auto section :
             {CpfgSection::productions, CpfgSection::decomposition, CpfgSection::homomorphism})
            for (const CpfgProduction& production : productions_[section])
                write_production(scratch, production, "", section);
        // Macros that are numbers may use others.
        std::string text = scratch.text;
        for (auto macro = source_.macros.rbegin(); macro != source_.macros.rend(); ++macro)
            if (lets_.contains(macro->name) && uses(text, macro->name)) text += macro->body + " ";
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

    std::string declared() const {
        std::string names;
        for (const std::string& name : declared_)
            names += (names.empty() ? "" : " ") + name;
        return names;
    }

    void write_table(Translation& out, std::size_t place) {
        const std::vector<double>& values = view_.functions[place].values;
        std::string text = fmt::format("  table {} =", table_name(place));
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
        if (filter_.empty()) return;
        std::set<std::string> names;
        std::string text;
        for (const CpfgModule& module : string_of(filter_symbols_, filter_span_)) {
            if (std::string_view("[]{}").find(module.symbol) != std::string_view::npos) continue;
            const std::string name = name_of(module.symbol);
            if (names.insert(name).second) text += " " + name;
        }
        if (!text.empty()) out.line(fmt::format("  {}{}", filter_, text), filter_span_);
    }

    void write_section(Translation& out, CpfgSection section, const char* word) {
        if (productions_[section].empty()) return;
        out.line(fmt::format("  {} {{", word));
        for (const CpfgProduction& production : productions_[section])
            write_production(out, production, "    ", section);
        out.line("  }");
    }

    void write_production(Translation& out, const CpfgProduction& production, const char* indent,
                          CpfgSection section) {
        comments(out, production.comments, indent);
        std::string text = indent;
        if (section == CpfgSection::productions && production.has_left && !production.left.empty())
            text += formals(production.left) + " < ";
        text += formals(production.predecessor);
        if (section == CpfgSection::productions && production.has_right && !production.right.empty())
            text += " > " + formals(production.right);
        if (section != CpfgSection::productions && (!production.left.empty() || !production.right.empty()))
            error(production.span, "a context of a decomposition or homomorphism has no translation");
        if (!production.condition.empty() || !production.locals.empty())
            text += " : " + (production.condition.empty() ? "1" : production.condition);
        bool first = true;
        for (const auto& [name, value] : production.locals) {
            text += fmt::format("{}{} = {}", first ? " with " : ", ", name, value);
            first = false;
        }
        const bool raw = section == CpfgSection::homomorphism && depth_of(section) == 1;
        const std::string successor = text_of(production.successor, production.span, raw);
        text += " -> " + (successor.empty() ? "*" : successor);
        if (!production.probability.empty()) text += " : " + production.probability;
        out.line(text, production.span);
    }

    int depth_of(CpfgSection section) const {
        const auto known = depth_.find(section);
        return known == depth_.end() ? 1 : std::atoi(known->second.substr(0, 9).c_str());
    }

    std::string formals(const CpfgString& string) {
        std::string text;
        for (const CpfgModule& module : string) {
            text += name_of(module.symbol);
            if (!module.has_parentheses) continue;
            text += "(";
            for (std::size_t i = 0; i < module.parameters.size(); ++i)
                text += (i == 0 ? "" : ", ") + module.parameters[i];
            text += ")";
        }
        return text;
    }

    /// The module of ours that has this name in productions.
    std::string name_of(const std::string& symbol) {
        if (symbol.size() > 1) {
            if (symbol[0] == '~') return "Surface_" + symbol.substr(1);
            return symbol;
        }
        const char c = symbol[0];
        if (std::string_view("FfGg+-&^\\/|[]{}.%!;,").find(c) != std::string_view::npos) return symbol;
        std::string name = c == 'T' ? "TT" : symbol_name(c);
        if (name.size() > 1 || !has_production(symbol)) declared_.insert(name);
        return name;
    }

    bool has_production(const std::string& symbol) const {
        return std::ranges::any_of(productions_, [&](const auto& section) {
            return std::ranges::any_of(section.second, [&](const CpfgProduction& production) {
                return !production.predecessor.empty() && production.predecessor[0].symbol == symbol;
            });
        });
    }

    /// Whether the homomorphism would draw this module as something else.
    bool is_drawn_otherwise(const CpfgModule& module) const {
        const auto section = productions_.find(CpfgSection::homomorphism);
        if (section == productions_.end()) return false;
        return std::ranges::any_of(section->second, [&](const CpfgProduction& production) {
            return production.predecessor.size() == 1 && production.predecessor[0].symbol == module.symbol &&
                   production.predecessor[0].parameters.size() == module.parameters.size();
        });
    }

    /// `raw`: no module of the string is drawn as another one.
    std::string text_of(const CpfgString& string, Span span, bool raw = false) {
        std::string text;
        for (const CpfgModule& module : string)
            text += text_of(module, span, raw && is_drawn_otherwise(module));
        return text;
    }

    std::string parameters(const CpfgModule& module, Span span, bool raw) {
        std::string text;
        for (const std::string& parameter : module.parameters)
            text += (text.empty() ? "" : ", ") + expression(parameter, span);
        // The turtle passes over parameters beyond those that it needs, and no production is for so many.
        if (raw && module.parameters.empty()) text = default_parameter(module.symbol, span);
        if (raw && !module.parameters.empty()) text += ", 0";
        return text.empty() ? text : "(" + text + ")";
    }

    std::string default_parameter(const std::string& symbol, Span span) {
        if (std::string_view("FfGg").find(symbol) != std::string_view::npos) return "1";
        if (std::string_view("+-&^\\/").find(symbol) != std::string_view::npos)
            return fmt::format("{}", view_.angle_deg);
        const bool means_nothing = symbol.size() == 1 && std::isalnum(static_cast<unsigned char>(symbol[0]));
        if (!means_nothing)
            error(span, fmt::format("'{}' in the homomorphism of itself has no translation", symbol));
        return "0";
    }

    std::string text_of(const CpfgModule& module, Span span, bool raw) {
        const std::string& symbol = module.symbol;
        if (symbol[0] == '@' && symbol.size() > 1) return directive(module, span);
        if (symbol[0] == '~') return surface(module, span);
        if (symbol == "?" || symbol == "$") {
            error(span, symbol == "?" ? "queries of the turtle or the environment (?) have no translation"
                                      : "sub-L-systems ($) have no translation");
            return "";
        }
        if (symbol == "!" || symbol == "#") return width(module, span);
        if ((symbol == ";" || symbol == ",") && module.parameters.empty()) {
            const int times = std::clamp(view_.colour_increment, 0, 255) % 8;
            return std::string(static_cast<std::size_t>(times), symbol[0]);
        }
        if ((symbol == "[" || symbol == "]" || symbol == "{" || symbol == "}") && module.has_parentheses)
            warn_once(span, fmt::format("the parameters of '{}' are left out", symbol));
        if (symbol == "[" || symbol == "]" || symbol == "{" || symbol == "}") return symbol;
        if (symbol == "_" || symbol == "s") warn_once(span, fmt::format("'{}' means nothing here", symbol));
        return name_of(symbol) + parameters(module, span, raw);
    }

    std::string surface(const CpfgModule& module, Span span) {
        const auto known = view_.surfaces.find(module.symbol.size() > 1 ? module.symbol[1] : ' ');
        if (known == view_.surfaces.end()) {
            error(span, fmt::format("the view file names no surface for '{}'", module.symbol));
            return "";
        }
        if (module.parameters.size() > 1) {
            error(span, fmt::format("'{}' with a scale for each axis has no translation", module.symbol));
            return "";
        }
        used_surfaces_.insert(known->first);
        warn_once(span, "surfaces have the material of leaves, whatever the colour of the turtle");
        const std::string scale = fmt::format("{}", known->second.scale);
        if (module.parameters.empty()) return fmt::format("~{}({})", surface_name(known->first), scale);
        return fmt::format("~{}({}*({}))", surface_name(known->first), scale,
                           expression(module.parameters[0], span));
    }

    static std::string surface_name(char letter) { return "surface_" + std::string(1, letter); }

    std::string width(const CpfgModule& module, Span span) {
        if (view_.width_in_pixels) {
            warn_once(span, "widths in pixels are left out: lines are as thick as the figure asks");
            return "";
        }
        if (!module.parameters.empty()) return "!" + parameters(module, span, false);
        if (view_.width_increment != 0)
            error(span, fmt::format("'{}' without a width, which adds {} to it, has no translation",
                                    module.symbol, view_.width_increment));
        return "";
    }

    std::string directive(const CpfgModule& module, Span span) {
        constexpr std::string_view same[] = {"@o", "@c", "@O", "@Gs", "@Gc", "@Ge", "@Di", "@Dd"};
        if (std::ranges::find(same, module.symbol) != std::end(same)) {
            const bool cylinder = module.symbol[1] == 'G';
            return module.symbol + (cylinder ? "" : parameters(module, span, false));
        }
        if (module.symbol == "@v") return "$";
        constexpr std::pair<std::string_view, const char*> left_out[] = {
            {"@#", "contours of generalized cylinders are left out: they are round"},
            {"@!", "how many sides a cylinder has is left out: cylinders are round"},
            {"@Gt", "the shapes of generalized cylinders between their points are left out"},
            {"@Gr", "the shapes of generalized cylinders between their points are left out"},
            {"@L", "labels are left out"},
            {"@S", "commands of the shell are left out"},
            {"@;", "colours of back sides are left out"},
            {"@,", "colours of back sides are left out"}};
        for (const auto& [symbol, message] : left_out)
            if (symbol == module.symbol) return warn_once(span, message), "";
        error(span, fmt::format("the directive '{}' has no translation", module.symbol));
        return "";
    }

    const ForeignFile& file_;
    const ForeignModel& model_;
    const CpfgSource& source_;
    CpfgView view_;
    std::set<std::string> lets_;   ///< macros that are numbers
    std::set<std::string> warned_; ///< what was said
    int systems_ = 0;
    bool ended_ = false;
    CpfgSection section_ = CpfgSection::productions;
    std::vector<std::pair<std::string, Span>> head_comments_, axiom_comments_;
    std::string seed_, length_, filter_, filter_symbols_;
    Span seed_span_, length_span_, filter_span_, axiom_span_, globals_span_;
    bool stochastic_ = false;
    CpfgString axiom_;
    std::map<CpfgSection, std::string> depth_;
    std::map<CpfgSection, std::vector<CpfgProduction>> productions_;
    std::set<std::string> globals_;
    std::vector<std::pair<std::string, std::string>> globals_values_;
    std::set<std::size_t> used_tables_;
    std::set<char> used_surfaces_;
    std::set<std::string> declared_;
};

std::vector<ForeignModel> cpfg_models(const ForeignFile& file) {
    const std::string name = std::filesystem::path(file.sources.name(file.file)).stem().string();
    return {{name, file.span(0, std::min<std::size_t>(file.text().find('\n'), file.text().size()))}};
}

/// A line begins with "Lsystem:", and none includes lpfg's header, which is C++.
bool is_cpfg(std::string_view text) {
    if (is_binary(text)) return false;
    bool begins = false;
    for (const TextLine& line : lines_of(text, 0, text.size())) {
        const std::string_view words = trimmed(line.text);
        begins = begins || words.starts_with("Lsystem:") || words.starts_with("lsystem:");
        if (words.starts_with("#include") && words.find("lpfgall") != std::string_view::npos) return false;
    }
    return begins;
}

std::optional<Translation> translate_cpfg(const ForeignFile& file, const ForeignModel& model) {
    const std::optional<CpfgSource> source = read_cpfg_source(file);
    if (!source) return std::nullopt;
    return CpfgTranslator(file, model, *source).translate();
}

constexpr std::string_view cpfg_endings[] = {"l"};

} // namespace

Importer cpfg_importer() {
    return {"cpfg L-system", cpfg_endings, is_cpfg, cpfg_models, translate_cpfg};
}

} // namespace graftal
