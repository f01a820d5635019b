#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "compiler/light/sky_picture.h"
#include "compiler/support/status.h"
#include "compiler/support/texture_facts.h"
#include "runtime/image/texture.h"
#include "runtime/system/file.h"

namespace graftal {

/// Reads the picture in a file, reduced to `most_texels` while it is read. Requires most_texels > 0.
Status read_texture(const std::string& path, std::uint64_t most_texels, Texture& texture);

/// The pictures that models name, each read once in the life of the store. Threads may ask at once.
class TextureStore {
  public:
    /// Null after a failure. Samples of EXR files are linear, all others sRGB. One picture has at most 2^25
    /// texels, and all together 2^27 (512 MiB): larger ones are reduced while they are read, but not below
    /// 2^12 texels.
    std::shared_ptr<const Texture> load(const std::string& path, Status& status);

    /// The facts of a picture for the compiler (LowerOptions).
    Status look_at(const std::string& path, TextureFacts& facts);

    /// A sky's picture (sky_file.h), which counts as four times its texels.
    Status load_sky(const std::string& path, LoadedSkyPicture& loaded);

    /// Forgets those whose files are not as they were when they were read. Whether there are any.
    bool forget_changed();

  private:
    struct Entry {
        std::shared_ptr<const Texture> texture;
        FileStamp stamp; ///< of the file, when it was read
    };

    struct SkyEntry {
        LoadedSkyPicture loaded;
        FileStamp stamp;
    };

    std::mutex mutex_;
    std::map<std::string, Entry> known_;
    std::map<std::string, SkyEntry> skies_;
    std::uint64_t texels_of_all_ = 0;
};

/// Writes it as POV-Ray is to read it: PNG, 8 bit, sRGB, alpha 0 or 1. Does not commit.
Status write_texture(const PendingFile& pending, const Texture& texture);

} // namespace graftal
