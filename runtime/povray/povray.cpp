#include "runtime/povray/povray.h"

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

#include "runtime/system/file.h"

namespace graftal {

namespace {

/// An empty file that stands in for the settings of the user and of the machine.
constexpr const char* settings_file = "settings.ini";

std::string in_directory(const PovrayJob& job, const std::string& name) {
    return job.directory + "/" + name;
}

std::string describe(const PovrayJob& job, const PovrayMessage& message) {
    std::string text;
    if (message.line > 0) text = fmt::format("{} line {}: ", message.file, message.line);
    text += message.text;
    if (message.line == 0 || message.file != job.scene) return text;
    const std::string body = body_at(in_directory(job, job.scene), message.line);
    return body.empty() ? text : fmt::format("{} (in {})", text, body);
}

/// The first name in a line of a scene that a body has, or "".
std::string body_named(const std::string& line) {
    const std::size_t begin = line.find(" M_");
    if (begin == std::string::npos) return "";
    return line.substr(begin + 1, line.find(' ', begin + 1) - begin - 1);
}

/// POV-Ray's words about a failed run: its errors, else its last lines.
std::string complaints(const PovrayJob& job, const PovrayLog& log) {
    std::string text;
    for (const PovrayMessage& message : log.messages)
        if (message.kind != PovrayMessage::Kind::warning)
            text += fmt::format("\n    {}", describe(job, message));
    if (!text.empty()) return text;
    for (const std::string& line : log.last_lines)
        text += fmt::format("\n    {}", line);
    return text;
}

bool is_there(const std::string& path) {
    return ::access(path.c_str(), R_OK) == 0;
}

/// Why a run was no success, or "".
std::string failure(const PovrayJob& job, const PovrayLog& log, const ProcessResult& process) {
    if (process.cancelled) return "interrupted";
    if (process.signal == SIGKILL)
        return "the system killed POV-Ray; it may have run out of memory (use a smaller --memory for a "
               "smaller scene)";
    if (process.signal == SIGXCPU)
        return fmt::format("graftal stopped POV-Ray: it took more than {} seconds of processor time",
                           job.cpu_seconds);
    if (process.signal == SIGXFSZ)
        return "graftal stopped POV-Ray: it wrote a file larger than any picture of this size";
    if (process.signal) return fmt::format("POV-Ray crashed: {}", ::strsignal(process.signal));
    if (process.exit_code != 0)
        return fmt::format("POV-Ray failed with status {}:{}", process.exit_code, complaints(job, log));
    if (!log.finished)
        return fmt::format("POV-Ray ended with status 0 but did not finish:{}", complaints(job, log));
    if (!is_there(in_directory(job, job.picture))) return "POV-Ray finished without writing the picture";
    if (log.illegal_matrix)
        return "POV-Ray changed a placement that is too small for its precision: the picture is wrong";
    if (log.no_objects) return "POV-Ray found no objects in the scene";
    if (job.finite_objects && log.finite_objects &&
        (*log.finite_objects > *job.finite_objects ||
         *log.finite_objects + job.may_be_empty < *job.finite_objects))
        return fmt::format("POV-Ray found {} objects in a scene of {}: the picture is wrong",
                           *log.finite_objects, *job.finite_objects);
    return {};
}

/// POV-Ray's own folders: include files, fonts, and what the machine allows it.
std::vector<std::string> povray_folders(const std::string& program) {
    std::vector<std::string> folders = {"/etc/povray"};
    const std::string prefix = std::filesystem::path(program).parent_path().parent_path().string();
    for (const std::string version : {"", "-3.7", "-3.8"})
        for (const std::string& share : {std::string("/usr"), std::string("/usr/local"), prefix})
            folders.push_back(share + "/share/povray" + version);
    folders.push_back(prefix + "/etc/povray");
    folders.push_back(prefix + "/lib");
    return folders;
}

Confinement confinement_of(const PovrayJob& job) {
    constexpr std::uint64_t file_slack = 64u << 20,
                            bytes_a_pixel = 64; // a picture, and the state while it is made
    Confinement confinement;
    confinement.memory_bytes = job.memory_bytes;
    confinement.cpu_seconds = job.cpu_seconds;
    confinement.file_bytes = file_slack + bytes_a_pixel * static_cast<std::uint64_t>(job.width) *
                                              static_cast<std::uint64_t>(job.height);
    confinement.readable = povray_folders(find_program(job.program).value_or(job.program));
    confinement.writable = {job.directory};
    return confinement;
}

} // namespace

std::vector<std::string> povray_arguments(const PovrayJob& job) {
    std::vector<std::string> arguments = {
        "+I" + job.scene,
        "+O" + job.picture,
        fmt::format("+W{}", job.width),
        fmt::format("+H{}", job.height),
        "-D",
    };
    switch (job.format) {
    case PovrayJob::Format::srgb8:
        arguments.insert(arguments.end(), {"+FN8", "File_Gamma=srgb"});
        break;
    case PovrayJob::Format::linear16:
        arguments.insert(arguments.end(), {"+FN16", "File_Gamma=1.0"});
        break;
    case PovrayJob::Format::half:
        arguments.push_back("+FE");
        break;
    }
    if (job.threads > 0) arguments.push_back(fmt::format("+WT{}", job.threads));
    if (job.antialias) {
        // Every pixel is divided: four corners that agree say nothing about parts smaller than a pixel.
        // Jitter is off: a picture must not depend on how its blocks were shared among threads.
        for (const std::string& argument :
             {fmt::format("+A{:.2f}", job.antialias_threshold), std::string("+AM2"),
              fmt::format("+R{}", *job.antialias), std::string("-J")})
            arguments.push_back(argument);
    } else {
        arguments.push_back("-A");
    }
    return arguments;
}

Status povray_available(const std::string& program) {
    if (find_program(program)) return {};
    return Status::failure(
        fmt::format("cannot find the program '{}'; install it with 'apt-get install povray'", program));
}

PovrayResult run_povray(const PovrayJob& job) {
    PovrayResult result;
    result.status = povray_available(job.program);
    if (!result.status.ok()) return result;
    result.status = write_text(in_directory(job, settings_file), "");
    if (!result.status.ok()) return result;
    const std::string picture = in_directory(job, job.picture);
    ::unlink(picture.c_str());

    PovrayMessageReader reader(job.on_progress);
    ProcessOptions options;
    options.cancel = job.cancel;
    options.arguments = povray_arguments(job);
    options.arguments.insert(options.arguments.begin(), job.program);
    options.directory = job.directory;
    options.environment = {{"POVINI", settings_file}};
    if (!job.unconfined) {
        const std::string own = std::filesystem::absolute(job.directory).string();
        options.environment.insert(options.environment.end(),
                                   {{"HOME", own}, {"TMPDIR", own}, {"LC_ALL", "C"}});
        options.clean_environment = true;
        options.confinement = confinement_of(job);
    }
    options.on_error_text = [&](std::string_view text) { reader.feed(text); };
    result.process = run_process(options);
    reader.finish();
    result.log = reader.log();

    ::unlink(in_directory(job, settings_file).c_str());
    const std::size_t dot = job.picture.rfind('.');
    ::unlink(in_directory(job, job.picture.substr(0, dot) + ".pov-state").c_str());
    result.status = result.process.status;
    if (!result.status.ok()) return result;
    const std::string reason = failure(job, result.log, result.process);
    if (!reason.empty()) {
        ::unlink(picture.c_str());
        result.status = Status::failure(reason);
        return result;
    }
    // A short trace may end before POV-Ray says how far it is.
    reader.complete();
    return result;
}

std::string body_at(const std::string& path, int line) {
    std::ifstream file(path);
    std::string text, declared;
    for (int number = 1; number <= line && std::getline(file, text); ++number) {
        const std::string named = body_named(text);
        if (text.starts_with("#declare ")) declared = named;
        if (number == line) return named.empty() ? declared : named;
        if (text.starts_with('}')) declared.clear();
    }
    return "";
}

} // namespace graftal
