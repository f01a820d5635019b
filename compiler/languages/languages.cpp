#include "compiler/languages/languages.h"

namespace graftal {

// Languages, each in language.cpp of its folder.
Language lsys_language(); ///< L-systems
Language rifs_language(); ///< recurrent iterated function systems, and orbits
Language inst_language(); ///< Hart's textual instancing language, and the text form of graphs

std::span<const Language> languages() {
    // A text without a name that no keyword gives away is of the last: it is the text form of graphs.
    static const Language table[] = {lsys_language(), rifs_language(), inst_language()};
    return table;
}

} // namespace graftal
