// L-systems of Bourke: any text is translated into a model or refused (import_checks.h).

#include "tests/fuzz/import_checks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return graftal::fuzz::try_import("fuzz.txt", data, size);
}
