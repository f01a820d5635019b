#include "compiler/inst/variant_name.h"

#include <algorithm>

#include <fmt/format.h>

namespace graftal {

std::string free_variant_name(const std::string& name, std::string_view word, std::set<std::string>& taken,
                              std::map<std::string, unsigned>& numbers) {
    const std::size_t end = std::min(name.find('('), name.size());
    const std::string stem = name.substr(0, end);
    std::string found;
    do {
        found = fmt::format("{}.{}{}{}", stem, word, ++numbers[stem], name.substr(end));
    } while (!taken.insert(found).second);
    return found;
}

} // namespace graftal
