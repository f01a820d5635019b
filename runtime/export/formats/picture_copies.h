#pragma once

#include <initializer_list>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/light/sky_picture.h"
#include "runtime/export/formats.h"
#include "runtime/system/file.h"

namespace graftal {

/// The pictures of materials, written as PNG beside the file that names them.
class PictureCopies {
  public:
    explicit PictureCopies(const ExportJob& job) : job_(job) {}

    /// The name of the material's picture, as a file in the same folder says it. Requires that it has one.
    std::string name(MaterialId material);

    /// The material's picture as the model calls it, without folders and ending.
    static std::string stem(const Material& material);

    /// The name of a sky's picture, written as EXR: of longitude and latitude, its middle towards +z.
    std::string sky(const SkyPicture& picture);

    /// The picture itself. Requires that the material has one.
    std::vector<unsigned char> png(MaterialId material);

    const Status& status() const { return status_; }

    /// Commits the pictures that were named and the files, all or none.
    Status commit(std::initializer_list<PendingFile*> files);

  private:
    std::string unused(const std::string& stem, std::string_view ending);
    bool is_of_model(const std::string& name) const;
    PendingFile& begin(const std::string& name);

    const ExportJob& job_;
    std::set<std::string> used_;
    std::map<std::string, std::string> names_; ///< by the model's name of the picture
    std::vector<std::unique_ptr<PendingFile>> pending_;
    Status status_;
};

} // namespace graftal
