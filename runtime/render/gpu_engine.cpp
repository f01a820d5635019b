#include "runtime/render/gpu_engine.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "runtime/fit/fit_picture.h"
#include "runtime/gpu/gpu_picture.h"
#include "runtime/render/drawing.h"
#include "runtime/render/file_film.h"
#include "runtime/render/native_engine.h"
#include "runtime/render/scene_files.h"
#include "runtime/render/stopwatch.h"

namespace graftal {

namespace {

/// Steps of rays that stand for a second of the work allowed: a share of what an office's GPU takes.
constexpr double steps_a_second = 2e9;
/// Passes of a progressive picture: each has so many times the samples of the one before.
constexpr std::uint32_t growth_of_passes = 4;
/// Samples for AOVs, whose noise is only that of edges.
constexpr std::uint32_t most_aov_samples = 64;

/// One picture by a device, as far as that goes.
class GpuDrawing {
  public:
    GpuDrawing(const PreparedView& prepared, const RenderOptions& options, const CancelFlag& cancel)
        : prepared_(prepared), view_(prepared.viewed->view), options_(options), cancel_(cancel),
          plan_(plan_picture(prepared, options)), window_(window_of(options, view_.size)), file_(options),
          film_(options.film ? *options.film : file_) {
        picture_.width = window_.width;
        picture_.height = window_.height;
        picture_.channels = 3;
        picture_.pixels.resize(3 * window_.pixels());
    }

    /// The model for the kernel; nothing, and `why`, where it lacks something.
    std::optional<FlatModel> flat(std::string& why) const {
        std::optional<FlatModel> model;
        if (options_.fit)
            why = "a fit that is known already";
        else
            model = flat_model({*prepared_.prepared, view_, plan_.detail, prepared_.textures,
                                limits_of(*prepared_.prepared, view_, options_), plan_.wanted},
                               why);
        if (!model) why = "its kernel does not know " + why;
        return model;
    }

    Status draw(const FlatModel& model, const std::vector<Gpu*>& gpus) {
        film_.begin({window_, picture_.channels, view_, prepared_.prepared->cut});
        Status status;
        bool fits = false;
        for (const std::uint32_t frames : GpuPicture::rooms)
            if (!fits) status = draw(model, gpus, frames, fits);
        return status;
    }

    /// Whether some picture has appeared.
    bool has_begun() const { return report_.pictures > 0; }
    const NativeReport& report() const { return report_; }

  private:
    /// `fits`: rays have room for what lies in each other, as far as is known.
    Status draw(const FlatModel& model, const std::vector<Gpu*>& gpus, std::uint32_t frames, bool& fits) {
        fits = true;
        const std::uint32_t lattice = lattice_of(plan_.wanted);
        const std::uint32_t most = lattice > 0 ? GpuPicture::lattice_points(lattice)
                                               : static_cast<std::uint32_t>(plan_.wanted.most_samples);
        GpuPicture drawing(gpus, view_.size, window_, {lattice, options_.sequence});
        const auto goes_on = [&](double share) {
            tell(share);
            return !cancel_.raised();
        };
        if (options_.needs_aovs()) {
            bool lost = false;
            GpuPicture aovs(gpus, view_.size, window_, {lattice, options_.sequence, true});
            Status status = aovs.prepare(model, frames);
            if (status.ok())
                status = aovs.sample(lattice > 0 ? most : std::min(most, most_aov_samples), goes_on);
            if (status.ok()) status = aovs.read_aovs(model, aovs_, lost);
            if (!status.ok()) return status;
            fits = !lost;
            if (!fits) return no_room();
        }
        if (Status status = drawing.prepare(model, frames); !status.ok()) return status;
        const double most_steps = options_.work(view_.quality) * steps_a_second;
        // The first sample tells what the others take, and whether they have room.
        for (std::uint32_t done = 0, count = 1;;) {
            Status status = drawing.sample(
                count, [&](double share) { return goes_on((done + share * (count - done)) / most); });
            if (!status.ok() && !(cancel_.raised() && has_begun())) return status;
            GpuPicture::Seen seen;
            if (Status read = drawing.read(view_.film, plan_.wanted.noise_255, picture_, seen); !read.ok())
                return read;
            fits = !seen.lost;
            if (!fits) return no_room();
            done = count;
            const double left = most_steps - seen.steps;
            const auto affordable = static_cast<std::uint32_t>(
                std::clamp(done * left / std::max(seen.steps, 1.0), 0.0, static_cast<double>(most)));
            const bool finished = done == most, last = finished || affordable == 0 || !status.ok();
            if (last || options_.progressive) {
                note(seen, lattice > 0 ? 0 : count, drawing.seconds());
                film_.tile(window_, picture_, pass_);
                if (Status shown = film_.end(pass_++, picture_, options_.needs_aovs() ? &aovs_ : nullptr);
                    !shown.ok())
                    return shown;
                if (report_.pictures++ == 0) report_.first_picture_seconds = watch_.seconds();
            }
            report_.finished = finished && status.ok();
            if (last) return status;
            count = std::min(options_.progressive ? growth_of_passes * done : most, done + affordable);
            count = std::min(count, most);
        }
    }

    static Status no_room() { return Status::failure("its kernel has no room for parts that lie so deep"); }

    static std::uint32_t lattice_of(const Sampling& wanted) {
        if (wanted.most_samples > 0) return 0;
        return wanted.antialias ? std::uint32_t{1} << static_cast<unsigned>(*wanted.antialias - 1) : 1;
    }

    void note(const GpuPicture::Seen& seen, std::uint32_t samples, double seconds) {
        report_.rays = {};
        report_.rays.camera_rays = static_cast<std::uint64_t>(seen.samples);
        report_.rays.work = static_cast<std::uint64_t>(seen.steps);
        report_.rays.noisy_pixels = seen.noisy;
        if (seen.noise_255 > 0) {
            report_.rays.measured_pixels = window_.pixels();
            report_.rays.noise_1024 =
                static_cast<std::uint64_t>(seen.noise_255 * 1024 * static_cast<double>(window_.pixels()));
        }
        report_.samples_a_pixel = samples > 0 ? samples : plan_.wanted.samples_a_pixel();
        report_.fewer_where_calm = plan_.wanted.noise_255 > 0 && samples > 0;
        report_.error_px = plan_.detail.culls() ? plan_.detail.error_px : 0;
        report_.seconds = seconds;
    }

    void tell(double share) const {
        if (options_.on_progress)
            options_.on_progress({report_.pictures ? "refining" : "tracing", share, report_.samples_a_pixel});
    }

    const PreparedView& prepared_;
    const View& view_;
    const RenderOptions& options_;
    const CancelFlag& cancel_;
    const PicturePlan plan_;
    const Tile window_;
    FileFilm file_;
    PictureFilm& film_;
    Image picture_;
    AovPicture aovs_; ///< empty where none are asked for
    NativeReport report_;
    int pass_ = 0;
    Stopwatch watch_;
};

void note_native(const PreparedView& prepared, std::string_view why, Compilation& compilation) {
    const Graph& graph = prepared.viewed->model->graph;
    compilation.diagnostics.note(graph.objects[graph.root].span,
                                 fmt::format("the processors draw this picture, not the GPU: {}", why));
}

/// Devices that draw a picture together.
class GpuTeam {
  public:
    /// Opens the devices of these numbers; of none, all cards of the first one's kind, which round alike.
    Status open(const std::vector<std::size_t>& wanted) {
        Status status;
        for (const std::size_t number : wanted.empty() ? cards_alike() : wanted) {
            std::unique_ptr<Gpu> gpu = Gpu::open(number, status);
            if (!gpu) return status;
            gpus_.push_back(std::move(gpu));
        }
        wanted_ = wanted;
        return status;
    }

    bool is_of(const std::vector<std::size_t>& wanted) const { return !gpus_.empty() && wanted_ == wanted; }

    std::vector<Gpu*> gpus() const {
        std::vector<Gpu*> gpus;
        gpus.reserve(gpus_.size());
        for (const std::unique_ptr<Gpu>& gpu : gpus_)
            gpus.push_back(gpu.get());
        return gpus;
    }

    std::string name() const {
        const std::string& first = gpus_.front()->info().name;
        return gpus_.size() == 1 ? first : fmt::format("{} devices: {}", gpus_.size(), first);
    }

  private:
    static std::vector<std::size_t> cards_alike() {
        std::vector<std::size_t> alike = {0};
        const std::vector<GpuInfo> devices = gpu_devices();
        for (std::size_t i = 1; i < devices.size(); ++i)
            if (devices[i].name == devices.front().name) alike.push_back(i);
        return alike;
    }

    std::vector<std::size_t> wanted_;
    std::vector<std::unique_ptr<Gpu>> gpus_;
};

/// The devices of the picture before, with their kernel: to open one takes longer than most frames of a film.
/// They stay open to the end of the process, where drivers may be gone before them.
class KeptGpus {
  public:
    Status take(const std::vector<std::size_t>& wanted, GpuTeam& team) {
        {
            const std::lock_guard lock(mutex_);
            if (team_.is_of(wanted)) {
                std::swap(team, team_);
                return {};
            }
        }
        return team.open(wanted);
    }

    /// Requires devices that work.
    void keep(GpuTeam team) {
        const std::lock_guard lock(mutex_);
        std::swap(team_, team);
    }

    static KeptGpus& instance() {
        static KeptGpus& kept = *new KeptGpus;
        return kept;
    }

  private:
    std::mutex mutex_;
    GpuTeam team_;
};

std::optional<DrawReport> draw(PictureSession& session, const RenderOptions& options,
                               Compilation& compilation) {
    const Stopwatch preparing;
    PreparedView prepared;
    if (!prepare_view(session, options, prepared, compilation)) return std::nullopt;
    if (!options.film) compilation.status = check_writable(options.output);
    if (!compilation.status.ok()) return std::nullopt;
    const CancelFlag cancel = session.control().cancel;
    GpuDrawing drawing(prepared, options, cancel);
    std::string why = options.aovs              ? "'--aovs' names what each sample meets"
                      : options.devices.empty() ? why_no_card()
                                                : "";
    std::optional<FlatModel> model;
    if (why.empty()) model = drawing.flat(why);
    if (model) {
        GpuTeam team;
        Status status = KeptGpus::instance().take(options.devices, team);
        const double prepared_seconds = preparing.seconds();
        if (status.ok()) status = drawing.draw(*model, team.gpus());
        if (status.ok() || cancel.raised()) {
            compilation.status = status;
            if (!drawing.has_begun()) return std::nullopt;
            compilation.times.push_back({"prepare", prepared_seconds});
            compilation.times.push_back({"trace", drawing.report().seconds});
            const std::string name = team.name();
            if (status.ok()) KeptGpus::instance().keep(std::move(team));
            return report_of(drawing.report(), name);
        }
        why = status.message();
    }
    note_native(prepared, why, compilation);
    std::optional<NativeReport> drawn = trace_model(prepared, options, preparing, cancel, compilation);
    if (drawn) drawn->whole_seconds = options.seconds_before + preparing.seconds();
    return drawn ? std::optional(report_of(*drawn)) : std::nullopt;
}

} // namespace

std::string why_no_card() {
    std::string why;
    const std::vector<GpuInfo> devices = gpu_devices(&why);
    if (devices.empty() || !devices.front().is_processor) return why;
    return fmt::format("there is no graphics card ('--device 0' draws by {}, a driver that takes far longer)",
                       devices.front().name);
}

bool has_gpu() {
    static const bool found = [] {
        // Without a node of a card there is none, and Vulkan's drivers by software take long to start.
        constexpr const char* nodes[] = {"/dev/dri", "/dev/nvidiactl", "/dev/dxg"};
        if (std::ranges::none_of(nodes, [](const char* node) {
                std::error_code none;
                return std::filesystem::exists(node, none);
            }))
            return false;
        return why_no_card().empty();
    }();
    return found;
}

constinit const Engine gpu_engine = {
    .name = "gpu",
    .summary = "graftal's own on the graphics card",
    .progressive = true,
    .available = []() -> Status {
        std::string why;
        if (!gpu_devices(&why).empty()) return {};
        return Status::failure(
            fmt::format("GPU: {}: give '--engine native', or install a driver of Vulkan", why));
    },
    .refusal = [](const RenderOptions& options) -> std::string { return native_engine.refusal(options); },
    .compile = [](Session& session, const StageOptions& options, Compilation& compilation) -> bool {
        return session.viewed(options, compilation) != nullptr;
    },
    .draw = draw,
};

} // namespace graftal
