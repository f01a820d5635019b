// Times of pictures on a device of Vulkan, for tools/bench/gpu.
//   gpu_bench DEVICE WIDTHxHEIGHT        reads jobs from standard input, one a line: MODEL STEPS ZOOM SAMPLES
// STEPS is a number, or - for as deep as the error asks. It prints a line of JSON for each job: bytes of the
// model, and the milliseconds of the device for one ray a pixel without light, for one sample of light and
// for SAMPLES of them, medians of some runs after the device has warmed up, with the rays of a sample.
// Pictures on surfaces are left out.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "compiler/session/session.h"
#include "compiler/session/stages.h"
#include "runtime/gpu/gpu_picture.h"
#include "runtime/system/disk_files.h"

namespace graftal {
namespace {

constexpr int repeats = 7;
/// Cards lower their clocks while nothing runs.
constexpr double warming_seconds = 0.15;
constexpr std::uint32_t most_warming = 200;

struct Job {
    std::string model, steps, zoom;
    std::uint32_t samples = 1;
};

const auto never_cancelled = [](double) { return true; };

double median(std::vector<double> values) {
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

/// A picture that takes more and more samples.
class Series {
  public:
    Series(GpuPicture& picture, bool software) : picture_(picture), software_(software) {}

    Status warm_up() {
        Status status;
        const std::uint32_t most = software_ ? 1 : most_warming;
        while (status.ok() && taken_ < most && picture_.seconds() < warming_seconds)
            status = picture_.sample(++taken_, never_cancelled);
        return status;
    }

    /// Milliseconds for `samples` more of each pixel.
    Status time(std::uint32_t samples, double& ms) {
        std::vector<double> times;
        for (int i = 0; i < (software_ ? 1 : samples > 1 ? 3 : repeats); ++i) {
            const double before = picture_.seconds();
            taken_ += samples;
            if (Status status = picture_.sample(taken_, never_cancelled); !status.ok()) return status;
            times.push_back(1000 * (picture_.seconds() - before));
        }
        ms = median(times);
        return {};
    }

    std::uint32_t taken() const { return taken_; }

  private:
    GpuPicture& picture_;
    const bool software_;
    std::uint32_t taken_ = 0;
};

Status measure(Gpu& gpu, ImageSize size, const Job& job, nlohmann::json& row) {
    StageOptions options;
    options.view.size = size;
    if (job.steps != "-") options.lower.steps = static_cast<unsigned>(std::stoul(job.steps));
    if (job.zoom != "1") options.view.zoom.zoom = Magnification::parse(job.zoom);
    Compilation compilation;
    Session session(job.model, disk_files());
    const auto viewed = session.viewed(options, compilation);
    const auto prepared = viewed ? session.prepared(options, compilation) : nullptr;
    if (!prepared) return Status::failure(compilation.diagnostics.render(compilation.sources));
    const View& view = viewed->view;
    std::string why;
    Sampling soft;
    soft.most_samples = static_cast<int>(job.samples);
    const std::optional<FlatModel> flat =
        flat_model({*prepared, view, resolved(options.detail, *viewed), ModelTextures(), {}, soft}, why);
    if (!flat) return Status::failure("the kernel does not know " + why);
    row["bytes"] = flat->bytes();
    const Tile window{0, 0, size.width, size.height};
    double ms = 0;
    {
        GpuPicture camera({&gpu}, size, window, {.aovs = true});
        Series series(camera, gpu.info().is_processor);
        Status status = camera.prepare(*flat);
        if (status.ok()) status = series.warm_up();
        if (status.ok()) status = series.time(1, ms);
        AovPicture aovs;
        bool lost = false;
        if (status.ok()) status = camera.read_aovs(*flat, aovs, lost);
        if (!status.ok()) return status;
        double met = 0;
        for (const AovPixel& pixel : aovs.pixels)
            met += static_cast<double>(pixel.coverage);
        row["camera_ms"] = ms;
        row["met"] = met / static_cast<double>(window.pixels());
        row["lost"] = lost;
    }
    GpuPicture light({&gpu}, size, window, {});
    Series series(light, gpu.info().is_processor);
    Status status = light.prepare(*flat);
    if (status.ok()) status = series.warm_up();
    if (status.ok()) status = series.time(1, ms);
    row["sample_ms"] = ms;
    if (status.ok() && job.samples > 1) status = series.time(job.samples, ms);
    row["samples_ms"] = ms;
    Image picture;
    picture.width = size.width;
    picture.height = size.height;
    picture.channels = 3;
    picture.pixels.resize(3 * window.pixels());
    GpuPicture::Seen seen;
    if (status.ok()) status = light.read(view.film, 0, picture, seen);
    const double samples = seen.samples;
    row["rays"] = seen.rays / std::max(samples, 1.0);
    row["steps"] = seen.steps / std::max(samples, 1.0);
    double sum = 0;
    for (const float value : picture.pixels)
        sum += static_cast<double>(value);
    row["mean"] = sum / static_cast<double>(picture.pixels.size());
    return status;
}

int run(int argc, char** argv) {
    ImageSize size{};
    if (argc != 3 || std::sscanf(argv[2], "%dx%d", &size.width, &size.height) != 2) return 2;
    Status status;
    const std::unique_ptr<Gpu> gpu = Gpu::open(static_cast<std::size_t>(std::atoi(argv[1])), status);
    if (!gpu) {
        std::fprintf(stderr, "%s\n", status.message().c_str());
        return 3;
    }
    for (std::string line; std::getline(std::cin, line);) {
        Job job;
        std::istringstream(line) >> job.model >> job.steps >> job.zoom >> job.samples;
        nlohmann::json row = {
            {"model", job.model}, {"steps", job.steps}, {"zoom", job.zoom}, {"samples", job.samples}};
        if (Status measured = measure(*gpu, size, job, row); !measured.ok())
            row["error"] = measured.message();
        std::printf("%s\n", row.dump().c_str());
        std::fflush(stdout);
    }
    return 0;
}

} // namespace
} // namespace graftal

int main(int argc, char** argv) {
    return graftal::run(argc, argv);
}
