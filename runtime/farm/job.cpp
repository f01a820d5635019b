#include "runtime/farm/job.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "compiler/session/shared_framing.h"
#include "runtime/farm/job_json.h"
#include "runtime/farm/join_tiles.h"
#include "runtime/image_files/image_files.h"
#include "runtime/render/frame_store.h"
#include "runtime/system/file.h"
#include "runtime/system/files_below.h"

namespace graftal {

namespace {

using Json = JobJson;

constexpr int format = 1; ///< of the manifest
constexpr std::uint64_t most_manifest_bytes = 16u << 20;
constexpr int longest_side = 131'072;
constexpr int most_samples = 1'000'000;

ImageSize size_from(const Json& json) {
    return {small_whole_of_json(json.at(0), longest_side), small_whole_of_json(json.at(1), longest_side)};
}

Json json_of(const PictureFit& fit) {
    const Sampling& sampling = fit.sampling;
    return {{"size", {fit.size.width, fit.size.height}},
            {"error_px", fit.error_px},
            {"error_world", fit.error_world ? Json(*fit.error_world) : Json(nullptr)},
            {"most_visits", fit.most_visits},
            {"block", sampling.block},
            {"antialias", sampling.antialias ? Json(*sampling.antialias) : Json(nullptr)},
            {"most_samples", sampling.most_samples},
            {"noise_255", sampling.noise_255},
            {"seconds", fit.seconds}};
}

PictureFit fit_from(const Json& json) {
    PictureFit fit;
    fit.size = size_from(json.at("size"));
    fit.error_px = json.at("error_px");
    if (!json.at("error_world").is_null()) fit.error_world = json.at("error_world").get<double>();
    fit.most_visits = whole_of_json(json.at("most_visits"));
    fit.sampling.block = small_whole_of_json(json.at("block"), longest_side);
    if (!json.at("antialias").is_null())
        fit.sampling.antialias = small_whole_of_json(json.at("antialias"), 9);
    fit.sampling.most_samples = small_whole_of_json(json.at("most_samples"), most_samples);
    fit.sampling.noise_255 = json.at("noise_255");
    fit.seconds = amount_of_json(json.at("seconds"));
    return fit;
}

Json json_of(const Job& job) {
    Json files = Json::array(), axes = Json::array();
    for (const JobFile& file : job.files)
        files.push_back({{"name", file.name}, {"digest", file.digest}});
    for (const SweepAxis& axis : job.axes)
        axes.push_back({{"name", axis.name}, {"values", axis.values}});
    Json json = {{"format", format},
                 {"program", job.program},
                 {"kind", name_of(job.kind)},
                 {"command", job.words},
                 {"result", job.result},
                 {"home", job.home},
                 {"tasks", job.tasks},
                 {"task_seconds", job.task_seconds},
                 {"task_bytes", job.task_bytes},
                 {"files", files}};
    if (job.kind == JobKind::tiles) json["tile"] = {job.tile.width, job.tile.height};
    if (job.fit) json["fit"] = json_of(*job.fit);
    if (!job.framing.empty()) {
        json["sources"] = job.sources;
        json["framing"] = Json::parse(job.framing);
    }
    if (!axes.empty()) json["axes"] = axes;
    return json;
}

Job job_from(const Json& json) {
    Job job;
    job.program = json.at("program");
    const std::string kind = json.at("kind");
    for (const JobKind known : {JobKind::tiles, JobKind::frames, JobKind::sweep})
        if (kind == name_of(known)) job.kind = known;
    job.words = json.at("command").get<std::vector<std::string>>();
    job.result = json.at("result");
    job.home = json.value("home", "");
    job.tasks = whole_of_json(json.at("tasks"));
    job.task_seconds = amount_of_json(json.at("task_seconds"));
    job.task_bytes = whole_of_json(json.at("task_bytes"));
    for (const Json& file : json.at("files"))
        job.files.push_back({file.at("name"), file.at("digest")});
    if (json.contains("tile")) job.tile = size_from(json["tile"]);
    if (json.contains("fit")) job.fit = fit_from(json["fit"]);
    if (json.contains("framing")) {
        job.sources = json.at("sources");
        const ImageSize size = size_from(json["framing"].at("size"));
        if (size.width > 0 && size.height > 0) job.framing = json["framing"].dump();
    }
    if (json.contains("axes"))
        for (const Json& axis : json["axes"])
            job.axes.push_back({axis.at("name"), axis.at("values").get<std::vector<std::string>>()});
    return job;
}

/// Whether the numbers of a manifest fit together, whoever wrote it.
bool is_sound(const Job& job) {
    if (job.tasks < 1 || job.tasks > most_tasks || job.words.size() < 2) return false;
    if (job.words.front() != (job.kind == JobKind::frames ? "animate" : "render")) return false;
    if (job.kind == JobKind::sweep) return job.tasks == point_count(job.axes);
    if (job.kind == JobKind::frames) return SharedFraming::from_json(job.framing) != nullptr;
    if (!job.fit || job.tile.width < 1 || job.tile.height < 1) return false;
    const ImageSize size = job.fit->size;
    const Sampling& sampling = job.fit->sampling;
    if (size.width < 1 || size.height < 1 || sampling.block < 1 || sampling.antialias.value_or(1) < 1 ||
        sampling.antialias.value_or(1) > 9 || sampling.most_samples < 0 ||
        band_bytes(size, std::min(job.tile.height, size.height)) > most_band_bytes)
        return false;
    const auto rows =
        (static_cast<std::uint64_t>(size.height) + static_cast<std::uint64_t>(job.tile.height) - 1) /
        static_cast<std::uint64_t>(job.tile.height);
    return job.tasks == rows * job.tile_columns();
}

/// A name that plans give: in the folder, and with the ending of a picture or a film.
bool is_own_result(const std::string& result) {
    return is_name_below(result) && result.find('/') == std::string::npos &&
           std::filesystem::path(result).has_extension();
}

std::string digest_of(int descriptor) {
    Digest digest;
    std::array<char, 1 << 16> piece;
    ssize_t count = 0;
    while ((count = ::read(descriptor, piece.data(), piece.size())) > 0)
        digest.add(std::string_view(piece.data(), static_cast<std::size_t>(count)));
    return count < 0 ? std::string() : digest.text();
}

} // namespace

std::string_view name_of(JobKind kind) {
    switch (kind) {
    case JobKind::tiles:
        return "tiles";
    case JobKind::frames:
        return "frames";
    case JobKind::sweep:
        return "sweep";
    }
    return "";
}

std::uint64_t Job::tile_columns() const {
    return static_cast<std::uint64_t>((fit->size.width + tile.width - 1) / tile.width);
}

Tile Job::tile_of(std::uint64_t task) const {
    const int x = static_cast<int>((task - 1) % tile_columns()) * tile.width;
    const int y = static_cast<int>((task - 1) / tile_columns()) * tile.height;
    return {x, y, std::min(tile.width, fit->size.width - x), std::min(tile.height, fit->size.height - y)};
}

std::uint64_t Job::most_part_bytes() const {
    constexpr std::uint64_t most = 1u << 30, head = 1u << 20, bytes_a_pixel = 16;
    return kind == JobKind::tiles ? std::min(most, head + bytes_a_pixel * whole_of(tile).pixels()) : most;
}

std::string JobFolder::numbered(std::uint64_t task, std::string_view ending) const {
    return fmt::format("{}/{:06}{}", tasks(), task, ending);
}

std::string JobFolder::record(std::uint64_t task) const {
    return numbered(task, ".json");
}

std::string JobFolder::starts(std::uint64_t task) const {
    return numbered(task, ".starts");
}

std::string JobFolder::log(std::uint64_t task) const {
    return numbered(task, ".log");
}

std::string JobFolder::result(const Job& job) const {
    return (std::filesystem::path(path_) / job.result).string();
}

std::string JobFolder::part(const Job& job, std::uint64_t task) const {
    if (job.kind == JobKind::frames) return FrameStore(parts(), job.tasks).path(task - 1);
    return fmt::format("{}/{}_{:06}{}", parts(), job.kind == JobKind::tiles ? "tile" : "picture", task,
                       is_exr_name(job.result) ? ".exr" : ".png");
}

std::string JobFolder::identity() const {
    struct statx info = {};
    if (::statx(AT_FDCWD, path_.c_str(), 0, STATX_BASIC_STATS | STATX_BTIME, &info) != 0) return {};
    if (info.stx_uid != ::geteuid()) return {};
    return fmt::format("{}.{}.{}", info.stx_ino, info.stx_btime.tv_sec, info.stx_btime.tv_nsec);
}

Status JobFolder::read_file(const std::string& path, std::string& text, std::uint64_t most_bytes) const {
    return read_below(path_, name_of(path), text, most_bytes);
}

Status JobFolder::check_file(const std::string& path) const {
    return check_below(path_, name_of(path));
}

Status JobFolder::write_file(const std::string& path, std::string_view text) const {
    const Status status = check_file(path);
    return status.ok() ? write_text(path, text) : status;
}

std::string JobFolder::digest(const std::string& path, std::uint64_t most_bytes) const {
    return digest_below(path_, name_of(path), most_bytes);
}

bool JobFolder::has_result(const Job& job) const {
    std::error_code error;
    return std::filesystem::exists(result(job), error);
}

Status JobFolder::check_result(const Job& job) const {
    return is_own_result(job.result) ? check_file(result(job)) : Status();
}

Status JobFolder::write(const Job& job) const {
    return write_file(manifest(), json_of(job).dump(1) + "\n");
}

Status JobFolder::read(Job& job) const {
    struct stat info = {};
    if (::lstat(manifest().c_str(), &info) != 0)
        return Status::failure(
            fmt::format("'{}' holds no job: 'graftal farm plan MODEL -o {}' makes one", path_, path_));
    std::string text;
    if (Status status = read_file(manifest(), text, most_manifest_bytes); !status.ok()) return status;
    bool known = true;
    const std::string problem = read_job_json(text, [&](const Json& json) {
        known = json.at("format") == format;
        if (known) job = job_from(json);
    });
    if (!known)
        return Status::failure(
            fmt::format("'{}' is of another version of graftal; plan the job again", manifest()));
    if (!problem.empty()) return Status::failure(fmt::format("'{}' is damaged: {}", manifest(), problem));
    if (!is_sound(job)) return Status::failure(fmt::format("'{}' contradicts itself", manifest()));
    if (is_own_result(job.result) || is_at_home(job)) return {};
    return Status::failure(
        fmt::format("the job's result '{}' lies outside of '{}', and the job was not planned in "
                    "this very folder: plan it again",
                    job.result, path_));
}

std::string digest_below(const std::string& folder, std::string_view name, std::uint64_t most_bytes) {
    const int file = open_below(folder, name);
    if (file < 0) return {};
    struct stat info = {};
    const bool fits = ::fstat(file, &info) == 0 && static_cast<std::uint64_t>(info.st_size) <= most_bytes;
    const std::string digest = fits ? digest_of(file) : "";
    ::close(file);
    return digest;
}

std::string file_digest(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return {};
    const std::string digest = digest_of(file);
    ::close(file);
    return digest;
}

std::string program_identity(const std::string& version) {
    return "graftal " + version + " " + file_digest("/proc/self/exe");
}

} // namespace graftal
