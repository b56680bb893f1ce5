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

/// The tissues, those along the planned path first, and under the chosen one its numbers. Object names:
/// "parameter-tissue-liver" (header; Space or Enter opens and closes), "parameter-liver-k" … (rows, see ParameterRow),
/// "parameter-liver-reset-all".
class ParameterList : public QWidget {
  Q_OBJECT

 public:
  explicit ParameterList(QWidget* parent = nullptr);
  /// Another table; the first tissue on the path is chosen, or the last chosen one where it is still there.
  void show_tissues(const std::vector<anatomy::TissueParameterGroup>& groups,
                    const std::vector<cases::PathPiece>& pieces);
  /// Numbers as they are now.
  void show_values(const ParameterEdits& edits);
  void show_model(const QString& force_model);
  /// Empty closes all.
  void choose(const std::string& tissue);
  const std::string& chosen() const noexcept { return chosen_; }
  /// Header and rows of the chosen tissue, in this widget; null: none is.
  QRect chosen_rect() const;
  /// The row of the chosen tissue with this setting says why a number was refused.
  void show_refusal(const std::string& setting, const QString& text);

 Q_SIGNALS:
  void edited(const std::string& setting, double value, bool joins);
  void reset_asked(const std::string& setting);
  void reset_tissue_asked(const std::string& tissue);
  /// The chosen tissue's rows have been made.
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
  QWidget* body_ = nullptr;  ///< Of the chosen section.
  QPushButton* reset_tissue_ = nullptr;
  std::vector<ParameterRow*> rows_;
};

}  // namespace trocar::trainer
