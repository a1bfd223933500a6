#pragma once
// A directory browser: which file to open, or where to write one.
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "app/gui.h"
#include "io/atomic_file.h"

namespace aspic::app {

/// What the dialog is opened for.
struct FileQuestion {
  std::string title;                      ///< also the name of the button that accepts
  std::vector<std::string_view> endings;  ///< of files that are listed: ".toml"; a new one gets the first
  bool writes = false;                    ///< a file that is there is replaced only when asked once more
  /// Takes the path. `overwrite` is allow where the user saw that the file exists.
  std::function<void(const std::string& path, Overwrite overwrite)> accept;
};

class FileDialog {
 public:
  /// Opens with the name in its field: one alone, or a path, whose directory is shown then. A directory that
  /// was shown before stays otherwise.
  void ask(FileQuestion question, const std::string& suggested);
  bool is_open() const { return open_; }
  void close() { open_ = false; }
  /// Once for each image, between Gui::begin and end; sizes in window units.
  void draw(Gui& gui, double width, double height);

 private:
  struct Entry {
    std::string name;
    bool is_directory = false;
  };
  void go_to(const std::string& directory);
  void list(Gui& gui, double height);
  void accept();
  std::string path() const;

  bool open_ = false, just_opened_ = false;
  FileQuestion question_;
  std::string directory_, name_, problem_;
  std::string warned_of_;  // a file that Enter would have replaced
  std::string missed_;     // a file that Enter would have opened
  std::vector<Entry> entries_;
};

}  // namespace aspic::app
