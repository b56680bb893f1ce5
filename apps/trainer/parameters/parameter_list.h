#pragma once

#include <QString>
#include <QWidget>
#include <string>
#include <vector>

#include "cases/force_curve.h"
#include "parameters/parameter_edits.h"
#include "parameters/parameter_row.h"

class QLabel;
class QPushButton;
class QVBoxLayout;

namespace trocar::trainer {

/// List of tissues, those along the planned path first, with the numbers of the selected one below it. Object names:
/// "parameter-tissue-liver" (header; Space or Enter opens and closes), "parameter-liver-k" … (rows, see ParameterRow),
/// "parameter-liver-reset-all".
class ParameterList : public QWidget {
  Q_OBJECT

 public:
  explicit ParameterList(QWidget* parent = nullptr);
  /// Sets another table; selects the first tissue on the path, or the previously selected tissue if it still exists.
  void show_tissues(const std::vector<anatomy::TissueParameterGroup>& groups,
                    const std::vector<cases::PathPiece>& pieces);
  /// Displays the present numbers.
  void show_values(const ParameterEdits& edits);
  void show_model(const QString& force_model);
  /// Selects a tissue; empty closes all.
  void choose(const std::string& tissue);
  const std::string& chosen() const noexcept { return chosen_; }
  /// Rectangle of header and rows of the selected tissue, in this widget; null if none is selected.
  QRect chosen_rect() const;
  /// Shows the reason for a refused number in the row of this setting of the selected tissue.
  void show_refusal(const std::string& setting, const QString& text);

 Q_SIGNALS:
  void edited(const std::string& setting, double value, bool joins);
  void reset_asked(const std::string& setting);
  void reset_tissue_asked(const std::string& tissue);
  /// The rows of the selected tissue were created.
  void opened(QWidget* header);

 private:
  struct Section {
    anatomy::TissueParameterGroup group;
    QString title, place;
    QPushButton* header = nullptr;
    QVBoxLayout* content = nullptr;
  };

  void add_section(const anatomy::TissueParameterGroup& group, const QString& place, QVBoxLayout& into);
  void fill(Section& section);
  void show_header(Section& section, bool is_changed) const;
  QWidget* make_rows(const anatomy::TissueParameterGroup& group);

  std::vector<Section> sections_;
  std::string chosen_, model_;
  QWidget* page_ = nullptr;  ///< All sections.
  QWidget* body_ = nullptr;  ///< Rows of the selected section.
  QPushButton* reset_tissue_ = nullptr;
  std::vector<ParameterRow*> rows_;
};

}  // namespace trocar::trainer
