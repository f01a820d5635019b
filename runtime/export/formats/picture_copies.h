#pragma once

#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/export/formats.h"
#include "runtime/system/file.h"

namespace graftal {

/// The pictures of materials, written as PNG beside the file that names them.
class PictureCopies {
  public:
    explicit PictureCopies(const ExportJob& job) : job_(job) {}

    /// The name of the material's picture, as a file in the same folder says it. Requires that it has one.
    std::string name(MaterialId material);

    /// The picture itself. Requires that the material has one.
    std::vector<unsigned char> png(MaterialId material);

    const Status& status() const { return status_; }

    /// Commits the pictures that were named and the files, all or none.
    Status commit(std::initializer_list<PendingFile*> files);

  private:
    const ExportJob& job_;
    std::map<std::string, std::string> names_; ///< by the model's name of the picture
    std::vector<std::unique_ptr<PendingFile>> pending_;
    Status status_;
};

} // namespace graftal
