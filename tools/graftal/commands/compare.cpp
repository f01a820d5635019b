#include <fmt/format.h>

#include "runtime/image_files/image_files.h"
#include "tools/graftal/commands.h"
#include "tools/graftal/report.h"

namespace graftal {

int run_compare(const Options& options) {
    Image pictures[2];
    for (int i = 0; i < 2; ++i) {
        const Status status = read_image(options.operands[static_cast<std::size_t>(i)], pictures[i]);
        if (status.ok()) continue;
        complain(status.message());
        return exit_environment;
    }
    const ImageDifference difference = compare_images(pictures[0], pictures[1], options.threshold);
    if (!difference.same_size) {
        complain(fmt::format("'{}' has {}x{} pixels, '{}' has {}x{}", options.operands[0], pictures[0].width,
                             pictures[0].height, options.operands[1], pictures[1].width, pictures[1].height));
        return exit_fault;
    }
    const int printed = options.quiet
                            ? exit_done
                            : print_output(fmt::format(
                                  "max   {:.9g}\nmean  {:.9g}\nrms   {:.9g}\np99   {:.9g}\ncount {} of {}\n",
                                  difference.max, difference.mean, difference.rms, difference.p99,
                                  difference.over_threshold, difference.pixels));
    if (printed != exit_done) return printed;
    return difference.over_threshold == 0 ? exit_done : exit_fault;
}

} // namespace graftal
