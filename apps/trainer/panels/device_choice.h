#pragma once

#include <QWidget>
#include <string>

class QBoxLayout;
class QComboBox;

namespace trocar::trainer {

/// Which device moves the needle and which the transducer, by name. A device that one tool has cannot be chosen for the
/// other. Each can be tested; a name that is not listed can be added and is remembered.
class DeviceChoice : public QWidget {
  Q_OBJECT

 public:
  explicit DeviceChoice(QWidget* parent = nullptr);

  /// As trocar-hapticd --device takes them; one that is not listed is added.
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
