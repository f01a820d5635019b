#include "compiler/languages/languages.h"

#include "compiler/inst/language.h"
#include "compiler/lsys/language.h"
#include "compiler/rifs/language.h"

namespace graftal {

std::span<const Language> languages() {
    // A text without a name that no keyword gives away is of the last: it is the text form of graphs.
    static const Language table[] = {lsys_language(), rifs_language(), inst_language()};
    return table;
}

} // namespace graftal
