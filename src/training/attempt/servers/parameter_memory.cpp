#include "attempt/servers/parameter_memory.h"

#include <utility>

namespace trocar::attempt {

void ParameterMemory::apply(const link::SetParameters& message) {
  std::vector<std::string> tissues;
  for (const std::string& setting : message.settings) {
    const std::string key = setting.substr(0, setting.find('='));
    const bool is_tissues = key != "force_model" && key != "bending" && !key.starts_with("coupling.");
    if (is_tissues) {
      tissues.push_back(setting);
    } else {
      options_[key] = setting;
    }
  }
  const bool has_table = !message.tissues_toml.empty();
  if (has_table) tissues_toml_ = message.tissues_toml;
  if (has_table || !tissues.empty() || message.settings.empty()) tissues_ = std::move(tissues);
}

link::SetParameters ParameterMemory::message() const {
  link::SetParameters all{tissues_, tissues_toml_};
  for (const auto& [key, setting] : options_) all.settings.push_back(setting);
  return all;
}

}  // namespace trocar::attempt
