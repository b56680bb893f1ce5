#pragma once

#include <QWidget>
#include <string>

class QBoxLayout;
class QComboBox;

namespace trocar::trainer {

/// Selection of the devices for needle and transducer, by name. One device cannot be selected for both tools. Each
/// device can be tested; a name that is not listed can be added and is stored.
class DeviceChoice : public QWidget {
  Q_OBJECT

 public:
  explicit DeviceChoice(QWidget* parent = nullptr);

  /// Values of trocar-hapticd --device; a value that is not listed is added.
  void choose(const std::string& needle, const std::string& probe);
  std::string needle() const;
  std::string probe() const;

 private:
  QComboBox* add_tool(QBoxLayout& column, const QString& title, const char* name, const char* test_name);
  void fill();
  void list(const QString& spec);
  void keep_apart();
  void add_by_name();
  void test(const QComboBox& box);

  QComboBox* needle_ = nullptr;
  QComboBox* probe_ = nullptr;
};

}  // namespace trocar::trainer
