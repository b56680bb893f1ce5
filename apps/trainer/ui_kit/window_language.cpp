#include "ui_kit/window_language.h"

#include <QCoreApplication>
#include <QHash>
#include <QLibraryInfo>
#include <QLocale>
#include <QRegularExpression>
#include <QSettings>
#include <QTranslator>
#include <algorithm>
#include <memory>
#include <vector>

#include "ui_kit/parts.h"

/// The resources of a static library are there once they are asked for; the macro needs the global namespace.
static void open_translations() {
  Q_INIT_RESOURCE(translations);
}

namespace trocar::trainer {
namespace {

constexpr const char* kLanguageKey = "window/language";
constexpr int kMostKept = 4'000;  ///< Texts whose translation is remembered: those of an attempt are about 500.

/// What speak() has chosen.
struct Spoken {
  language::Language language;
  QHash<QByteArray, QString> texts;  ///< Of shown(): the window asks for the same ones at every frame.
  std::vector<std::unique_ptr<QTranslator>> translators;
};

Spoken& spoken() {
  static Spoken of_window;
  return of_window;
}

/// The texts of tr(). Numbers in the translations take the language's decimal sign: "%1" stands for "%L1".
class WindowTranslator : public QTranslator {
 public:
  using QTranslator::QTranslator;
  QString translate(const char* context, const char* source, const char* comment, int count) const override {
    QString text = QTranslator::translate(context, source, comment, count);
    // Texts of tables, whose tr() is another one's: QT_TRANSLATE_NOOP("Table", "text").
    if (text.isNull()) text = QTranslator::translate("Table", source, comment, count);
    static const QRegularExpression place(QStringLiteral("%(\\d)"));
    return text.replace(place, QStringLiteral("%L\\1"));
  }
};

}  // namespace

QString chosen_language() {
  return QSettings().value(QString::fromLatin1(kLanguageKey)).toString();
}

void choose_language(const QString& code) {
  QSettings().setValue(QString::fromLatin1(kLanguageKey), code);
}

QString desktop_language() {
  const std::vector<language::LanguageEntry> entries = language::list_languages();
  for (const QString& wanted : QLocale::system().uiLanguages()) {
    const QString code = wanted.section(QLatin1Char('-'), 0, 0).section(QLatin1Char('_'), 0, 0);
    const auto found = std::ranges::find(entries, to_std(code), &language::LanguageEntry::code);
    if (found != entries.end()) return code;
  }
  return QStringLiteral("en");
}

Status speak(QCoreApplication& application, const QString& code) {
  TROCAR_TRY(language::Language language, language::load_language(to_std(code)));
  std::vector<std::unique_ptr<QTranslator>> translators;
  if (!language.is_english()) {
    open_translations();
    auto window = std::make_unique<WindowTranslator>();
    const QString file = QStringLiteral("trainer_") + code;
    if (!window->load(file, QStringLiteral(":/translations")))
      return fail("the window has no texts in this language", to_std(file), "build the program again");
    translators.push_back(std::move(window));
    // The texts of Qt's own dialogs; without their package these stay English.
    auto dialogs = std::make_unique<QTranslator>();
    if (dialogs->load(QStringLiteral("qtbase_") + code, QLibraryInfo::location(QLibraryInfo::TranslationsPath)))
      translators.push_back(std::move(dialogs));
  }
  QLocale locale = QLocale::system();
  if (!locale.name().startsWith(code)) locale = QLocale(code);
  locale.setNumberOptions(QLocale::OmitGroupSeparator | QLocale::RejectGroupSeparator);
  QLocale::setDefault(locale);
  spoken() = {std::move(language), {}, std::move(translators)};
  for (const auto& translator : spoken().translators) application.installTranslator(translator.get());
  return {};
}

const language::Language& window_language() {
  return spoken().language;
}

QString shown(std::string_view english) {
  Spoken& now = spoken();
  if (now.language.is_english()) return to_qt(english);
  const QByteArray key(english.data(), static_cast<int>(english.size()));
  const auto kept = now.texts.constFind(key);
  if (kept != now.texts.constEnd()) return *kept;
  if (now.texts.size() >= kMostKept) now.texts.clear();
  return *now.texts.insert(key, to_qt(now.language.translate(english)));
}

}  // namespace trocar::trainer
