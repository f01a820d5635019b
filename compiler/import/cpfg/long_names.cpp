#include "compiler/import/cpfg/long_names.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <set>
#include <utility>

namespace graftal {

namespace {

bool is_letter(const CpfgModule& module) {
    return module.symbol.size() == 1 && std::isalnum(static_cast<unsigned char>(module.symbol[0]));
}

bool alike(const CpfgModule& a, const CpfgModule& b) {
    return a.symbol == b.symbol && a.parameters.size() == b.parameters.size();
}

/// Several letters, of which the last may have parameters.
bool is_name(const CpfgString& string) {
    return string.size() > 1 && std::ranges::all_of(string, is_letter) &&
           std::all_of(string.begin(), string.end() - 1,
                       [](const CpfgModule& module) { return module.parameters.empty(); });
}

bool begins_with(const CpfgString& string, std::size_t at, const CpfgString& name) {
    return at + name.size() <= string.size() &&
           std::equal(name.begin(), name.end(), string.begin() + static_cast<std::ptrdiff_t>(at), alike);
}

void each_string(CpfgSystem& system, const std::function<void(CpfgString&)>& take) {
    take(system.axiom);
    for (auto& [section, productions] : system.productions)
        for (CpfgProduction& production : productions)
            for (CpfgString* string :
                 {&production.left, &production.predecessor, &production.right, &production.successor})
                take(*string);
}

CpfgModule joined(const CpfgString& string, std::size_t at, std::size_t count) {
    CpfgModule module = string[at + count - 1];
    module.symbol.clear();
    for (std::size_t i = 0; i < count; ++i)
        module.symbol += string[at + i].symbol;
    return module;
}

class NameJoiner {
  public:
    explicit NameJoiner(CpfgSystem& system) : system_(system) {
        for (auto& [section, productions] : system.productions)
            for (const CpfgProduction& production : productions) {
                if (production.predecessor.size() == 1)
                    rewritten_.insert(
                        {production.predecessor[0].symbol, production.predecessor[0].parameters.size()});
                if (section != CpfgSection::productions && is_name(production.predecessor) &&
                    !knows(production.predecessor))
                    names_.push_back(production.predecessor);
            }
        std::ranges::stable_sort(names_, std::greater<>(), &CpfgString::size);
    }

    void join() {
        // A letter that stands nowhere else keeps the sequence of its name from coming about by chance.
        each_string(system_, [&](CpfgString& string) { note_letters(string); });
        std::erase_if(names_, [&](const CpfgString& name) { return !is_closed(name); });
        if (names_.empty()) return;
        each_string(system_, [&](CpfgString& string) { join(string); });
    }

  private:
    bool knows(const CpfgString& name) const {
        return std::ranges::any_of(names_, [&](const CpfgString& known) {
            return known.size() == name.size() && begins_with(known, 0, name);
        });
    }

    /// Number of modules of the name that begins here; 0 if none does.
    std::size_t name_at(const CpfgString& string, std::size_t at) const {
        for (const CpfgString& name : names_)
            if (begins_with(string, at, name)) return name.size();
        return 0;
    }

    void note_letters(const CpfgString& string) {
        for (std::size_t i = 0; i < string.size();) {
            const std::size_t count = name_at(string, i);
            if (count == 0) single_.insert({string[i].symbol, string[i].parameters.size()});
            i += std::max<std::size_t>(count, 1);
        }
    }

    bool is_closed(const CpfgString& name) const {
        // Read from the left, a name is rewritten as a whole before what is in it.
        const bool falls_apart = rewritten_.contains({name[0].symbol, name[0].parameters.size()}) ||
                                 !name.back().parameters.empty();
        if (falls_apart && std::ranges::any_of(name, [&](const CpfgModule& module) {
                return rewritten_.contains({module.symbol, module.parameters.size()});
            }))
            return false;
        return std::ranges::any_of(name, [&](const CpfgModule& module) {
            return !single_.contains({module.symbol, module.parameters.size()});
        });
    }

    void join(CpfgString& string) const {
        CpfgString result;
        for (std::size_t i = 0; i < string.size();) {
            const std::size_t count = name_at(string, i);
            result.push_back(count == 0 ? string[i] : joined(string, i, count));
            i += std::max<std::size_t>(count, 1);
        }
        string = std::move(result);
    }

    CpfgSystem& system_;
    std::vector<CpfgString> names_;                                    ///< the longest first
    std::set<std::pair<std::string, std::size_t>> single_, rewritten_; ///< modules beside and in names
};

} // namespace

void join_cpfg_names(CpfgSystem& system) {
    NameJoiner(system).join();
}

} // namespace graftal
