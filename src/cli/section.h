// A section of the report that is always recorded, and printed if asked for.
#pragma once

#include <string>

#include "cli/report.h"
#include "cli/summaries.h"

namespace radiosity::cli {

/// Figures within its lifetime are recorded, and printed only if `detail` is full.
class Section {
 public:
  Section(Report& report, Detail detail, const std::string& key, const std::string& title)
      : report_(report) {
    report_.mute(detail != Detail::full);
    report_.section(key, title);
  }
  ~Section() { report_.mute(false); }
  Section(const Section&) = delete;
  Section& operator=(const Section&) = delete;

 private:
  Report& report_;
};

}  // namespace radiosity::cli
