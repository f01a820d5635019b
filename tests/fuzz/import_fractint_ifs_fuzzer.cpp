// `.ifs` of other programs, from text to verified graph: any input gives a graph or diagnostics, soon.

#include "tests/fuzz/round_trip.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    graftal::check_foreign_text("no_such_folder/fuzz.ifs", data, size);
    return 0;
}
