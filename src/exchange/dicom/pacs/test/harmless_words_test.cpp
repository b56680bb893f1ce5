// Which texts of a PACS stay: names and dates in many spellings do not, usual descriptions and structures do.
#include "dicom/pacs/detail/harmless_words.h"

#include <gtest/gtest.h>

#include <fstream>

#include "config/toml.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"

namespace trocar::dicom::detail {
namespace {

class HarmlessText : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto words = HarmlessWords::load(data_dir());
    ASSERT_TRUE(words) << words.error().text();
    words_ = *std::move(words);
  }
  static bool stays(std::string_view text, TextUse use = TextUse::kDescription,
                    Repertoire repertoire = Repertoire::kUtf8) {
    return words_.is_harmless(text, repertoire, use, IdentityWords());
  }
  static HarmlessWords words_;
};
HarmlessWords HarmlessText::words_;

TEST_F(HarmlessText, KeepsUsualSeriesDescriptions) {
  for (const char* text : {"Abdomen 3.0",
                           "CT 5mm",
                           "Abdomen  3.0  B30f",
                           "THORAX 1.0 B70f 2",
                           "CT Abdomen/Pelvis with contrast",
                           "arterial",
                           "PORTAL VENOUS PHASE 5 mm",
                           "Liver delayed 1.25mm",
                           "Thorax nativ",
                           "Abdomen arteriell",
                           "VENÖS 2,0 mm",
                           "portalvenös",
                           "foie portal 1 mm",
                           "Torace senza mdc",
                           "Abdomen sin contraste",
                           "Leber spät 120kV",
                           "Br40d3 axial 0.6",
                           "FC08 lung",
                           "Topogram 0.6 T20f",
                           "STANDARD",
                           "MIP 10 mm cor",
                           "SCOUT",
                           "L5-S1",
                           "Head 4.8 H31s",
                           "iDose4",
                           "Liver 70 keV",
                           "3D",
                           "Br40f",
                           "SOMATOM Definition AS+",
                           "WINDOW1",
                           ""})
    EXPECT_TRUE(stays(text)) << text;
}

TEST_F(HarmlessText, KeepsStructureNames) {
  for (const char* text : {"liver",
                           "Kidney_L",
                           "Kidney left",
                           "LungR",
                           "SpinalCord",
                           "vertebrae_L5",
                           "rib_left_10",
                           "rib7",
                           "liver_tumor_2",
                           "GTV",
                           "PTV",
                           "Segment 4",
                           "portal_vein_and_splenic_vein",
                           "Femur Head R",
                           "Leber",
                           "Niere links",
                           "HÍGADO",
                           "gallbladder",
                           "Bile ducts",
                           "lesion12",
                           "CTThorax",
                           "Tail of pancreas"})
    EXPECT_TRUE(stays(text, TextUse::kStructure)) << text;
}

/// Calls `use` with every name of the tables.
template <class Use>
void for_each_known_structure(Use use) {
  const auto total = config::load_toml(data_dir() / "totalsegmentator.toml")->table("labels");
  for (const std::string& key : total->keys()) use(*total->string(key));
  const auto tasks = config::load_toml(data_dir() / "totalsegmentator_tasks.toml")->table("tasks");
  for (const std::string& task : tasks->keys())
    for (const std::string& key : tasks->table(task)->keys()) use(*tasks->table(task)->string(key));
  const auto codes = config::load_toml(data_dir() / "structure_codes.toml");
  for (const std::string scheme : {"SCT", "SRT"}) {
    const auto table = codes->table(scheme);
    ASSERT_TRUE(table) << table.error().text();
    for (const std::string& key : table->keys())
      if (const std::string name = *table->string(key); name != "lip") use(name);  // also a month
  }
}

TEST_F(HarmlessText, KeepsEveryKnownStructureName) {
  int count = 0;
  for_each_known_structure([&](const std::string& name) {
    ++count;
    EXPECT_TRUE(stays(name, TextUse::kStructure)) << name;
  });
  EXPECT_GT(count, 400);
}

TEST_F(HarmlessText, NamesInAnySpellingAreReplaced) {
  for (const char* name : {"MÜLLER",
                           "Müller",
                           "Mueller",
                           "Muller",
                           "MU\u0308LLER",
                           "mu\u0308ller",
                           "M\u00adüller",
                           "ИВАНОВ",
                           "Иванов",
                           "ΠΑΠΑΔΌΠΟΥΛΟΣ",
                           "Παπαδόπουλος",
                           "ÇELİK",
                           "çelik",
                           "ışık",
                           "Işık",
                           "GROẞ",
                           "Groß",
                           "GROSS",
                           "Weiß",
                           "Strauss",
                           "O'Brien",
                           "Müller-Lüdenscheid",
                           "MuellerLuedenscheid",
                           "von der Heide",
                           "Nguyễn",
                           "Łukasz",
                           "Ångström",
                           "Þór",
                           "王小东",
                           "山田",
                           "ﾔﾏﾀﾞ",
                           "김희중",
                           "สมชาย",
                           "قباني",
                           "שרון",
                           "Ｍｕｅｌｌｅｒ",
                           "MÜLLER^ERIKA^^Dr.",
                           "Li",
                           "Max",
                           "Omar",
                           "Mar",
                           "Hart",
                           "Long",
                           "J. M."})
    for (const char* use : {"CT {} 5mm", "{}", "liver_{}", "Abdomen {}", "{}liver", "liver{}", "Abdomen[{}]"}) {
      std::string text = use;
      text.replace(text.find("{}"), 2, name);
      EXPECT_FALSE(stays(text)) << text;
      EXPECT_FALSE(stays(text, TextUse::kStructure)) << text;
    }
}

TEST_F(HarmlessText, DatesAndNumbersOfPatientsAreReplaced) {
  for (const char* date :
       {"17.03.1945", "1945-03-17", "19450317",      "17/03/45",     "17.3.45",   "17-03-45",  "3/17/1945",
        "17 03 45",   "170345",     "17. 3. 45",     "17.03.",       "17.03",     "7.3 45",    "17031945",
        "1945",       "17_03_45",   "17 March 1945", "17.März 45",   "17 mar 45", "17 set 45", "17 mrt 45",
        "17MAR45",    "45Y",        "045Y",          "45 J",         "M 45",      "10:15:30",  "4711",
        "PAT4711",    "A123456",    "P12",           "0049 30 1234", "17,03,45"})
    for (const char* use : {"geb. {}", "{}", "CT {}", "CT {} 5mm", "liver {}", "liver_{}"}) {
      std::string text = use;
      text.replace(text.find("{}"), 2, date);
      EXPECT_FALSE(stays(text)) << text;
    }
  EXPECT_FALSE(stays("geb. 5"));
  EXPECT_FALSE(stays(std::string(2000, '-'))) << "too long";
}

TEST_F(HarmlessText, ReplacesNamesOfMonths) {
  for (const char* month :
       {"jan", "feb", "mar", "apr", "may",   "jun",  "jul", "aug",  "sep", "sept", "oct",  "nov",  "dec",
        "mai", "okt", "dez", "mär", "maerz", "janv", "fév", "mars", "avr", "juin", "juil", "août", "déc",
        "gen", "mag", "giu", "lug", "ago",   "set",  "ott", "dic",  "ene", "abr",  "mrt",  "mei",  "out",
        "fev", "maj", "sty", "lut", "kwi",   "lip",  "sie", "wrz",  "paź", "lis",  "gru"})
    EXPECT_FALSE(stays(month)) << month;
}

TEST_F(HarmlessText, IsReadInItsCharacterSet) {
  EXPECT_TRUE(stays("ven\xf6s", TextUse::kDescription, Repertoire::kLatin1));
  EXPECT_FALSE(stays("ven\xf6s", TextUse::kDescription, Repertoire::kUtf8)) << "malformed";
  EXPECT_FALSE(stays("ven\xf6s", TextUse::kDescription, Repertoire::kAscii)) << "any other character set";
  EXPECT_FALSE(stays("venös", TextUse::kDescription, Repertoire::kLatin1)) << "UTF-8 that claims to be Latin-1";
  EXPECT_FALSE(stays("\x1b$B;3ED\x1b(B", TextUse::kDescription, Repertoire::kAscii)) << "ISO 2022 IR 87";
  EXPECT_FALSE(stays("CT\xcd\xf5", TextUse::kDescription, Repertoire::kAscii)) << "GB18030";
  EXPECT_FALSE(stays(std::string_view("CT\0X", 4))) << "a control character";
  EXPECT_FALSE(stays("\xc0\xae")) << "overlong";
  EXPECT_FALSE(stays("\xf0\x9f\x92\x89"));
}

TEST_F(HarmlessText, ReplacesAPersonNamedLikeAnOrgan) {
  IdentityWords names;
  names.add("Kopf^Low", Repertoire::kAscii);
  names.add("Liver^Hans", Repertoire::kAscii);
  const auto stays_with_names = [&](std::string_view text, TextUse use) {
    return words_.is_harmless(text, Repertoire::kLatin1, use, names);
  };
  EXPECT_FALSE(stays_with_names("CT KOPF", TextUse::kDescription));
  EXPECT_FALSE(stays_with_names("low dose", TextUse::kDescription));
  EXPECT_FALSE(stays_with_names("Kopf", TextUse::kStructure));
  EXPECT_FALSE(stays_with_names("Liver 5mm", TextUse::kDescription));
  EXPECT_TRUE(stays_with_names("Liver", TextUse::kStructure)) << "a structure that Trocar knows";
  EXPECT_TRUE(stays_with_names("CT Thorax", TextUse::kDescription));
}

TEST_F(HarmlessText, ReplacesEverySpellingOfAPersonsName) {
  struct Case {
    std::string name;
    std::vector<std::string> replaced;
    Repertoire repertoire = Repertoire::kUtf8;
  };
  for (const auto& [name, replaced, repertoire] : std::vector<Case>{
           {"Fuß^Anna", {"CT FUSS 5mm", "Fuß", "fuss"}},
           {"FUSS^Anna", {"CT Fuß", "fuss"}},
           {"Fu\xdf^Anna", {"CT FUSS 5mm", "Fuß"}, Repertoire::kLatin1},
           {"Fu\xdf^Anna", {"CT FUSS 5mm", "Fuß"}, Repertoire::kAscii},  // ISO_IR 101, 109, 148 have it there, too
           {"Fuß^Anna", {"CT FUSS 5mm"}, Repertoire::kAscii},            // UTF-8 that does not say so
           {"Früh^Anna", {"Abdomen FRUEH", "Früh", "früharteriell frueh"}},
           {"Frueh", {"Abdomen früh"}},
           {"Fru\u0308h", {"Abdomen frueh", "früh"}},
           {"Spät^A", {"Spaet venoes"}},
           {"Spat^A", {"Spaet venoes", "spät"}},
           {"Schädel^B", {"CT Schaedel nativ"}},
           {"Läsion", {"Laesion Leber"}},
           {"Arm^X", {"arms", "Arm", "ARME"}},
           {"Arms^X", {"arm"}},
           {"Stones^John", {"Stone"}},
           {"Vein", {"veins"}},
           {"Niere", {"Nieren"}},
           {"ＨＥＲＺ^Anna", {"CT Herz"}},
           {"ｈｅｒｚ", {"CT HERZ"}},
           {"Hërz", {"CT HERZ"}},
           {"HĘRŻ", {"CT HERZ"}},
           {"Kọpf", {"kopf"}},
           {"Cœur", {"coeur"}},
           {"Artère", {"artere", "ARTÈRE"}}}) {
    IdentityWords names;
    names.add(name, repertoire);
    for (const std::string& text : replaced) {
      EXPECT_TRUE(stays(text)) << text << ": must be on the list, or this proves nothing";
      EXPECT_FALSE(words_.is_harmless(text, Repertoire::kUtf8, TextUse::kDescription, names)) << name << ": " << text;
    }
    EXPECT_TRUE(words_.is_harmless("CT Thorax 5mm", Repertoire::kUtf8, TextUse::kDescription, names)) << name;
  }
}

TEST_F(HarmlessText, ReplacesNumbersThatMayBeDates) {
  for (const char* text : {"17.3", "CT 17.3", "17,3 liver", "31.1", "17 mm 03 mm 45 mm", "17 mm 3 mm 45 mm",
                           "17mm 3mm 45mm", "B30f 17s 03s 45s", "17s 3s 45s", "03 mm", "liver 17.3 5mm"})
    EXPECT_FALSE(stays(text)) << text;
  for (const char* text : {"12.5 mm", "12.5mm", "1.5", "7.3", "10.0", "32.5", "5mm 120kV 2s", "10 mm 5 mm",
                           "02 Abdomen", "Thorax 5mm Abdomen 3mm Becken 2mm"})
    EXPECT_TRUE(stays(text)) << text;
}

TEST_F(HarmlessText, KeepsCodedDicomValues) {
  for (const char* value :
       {"ORIGINAL", "CT_SOM5 SPI",  "MONOCHROME2",   "YBR_FULL_422", "ISO_10918_1", "HFS",           "L",
        "LPH",      "HELICAL MODE", "CLOSED_PLANAR", "FLAT",         "ABDOMEN",     "CHEST",         "LIVER",
        "3D",       "AXIAL",        "DIS2D",         "TILED_SPARSE", "ORGAN",       "SEMIAUTOMATIC", "NONE"})
    EXPECT_TRUE(words_.is_harmless_code(value)) << value;
  for (const char* value : {"MUELLER", "ERIKA", "RALPH", "19450317", "CT_MUELLER", "M\xdcLLER", "PAT4711", "17_03_45"})
    EXPECT_FALSE(words_.is_harmless_code(value)) << value;
}

TEST(HarmlessWordsFile, NamesMalformedLines) {
  const TemporaryFolder folder;
  for (const char* name :
       {"structures.toml", "structure_codes.toml", "totalsegmentator.toml", "totalsegmentator_tasks.toml"})
    std::filesystem::copy_file(data_dir() / name, folder / name);
  const auto error_of = [&](const std::string& text) {
    EXPECT_TRUE(write_file_atomically(folder / "harmless_words.toml", text));
    const auto words = HarmlessWords::load(folder.path());
    return words ? std::string() : words.error().text();
  };
  const std::string rest = "[units]\n[patterns]\n[codes]\n";
  EXPECT_EQ(error_of("[words]\na = [\"leber\"]\n" + rest), "");
  for (const char* word : {"Leber", "two words", "ct5", "", "иванов"}) {
    const std::string error = error_of("[words]\na = [\"" + std::string(word) + "\"]\n" + rest);
    EXPECT_NE(error.find("no single word"), std::string::npos) << word << error;
    EXPECT_NE(error.find("harmless_words.toml"), std::string::npos) << error;
  }
  EXPECT_NE(error_of("[wordz]\n" + rest), "");
  EXPECT_NE(error_of("[words]\na = 5\n" + rest), "");
  std::filesystem::remove(folder / "harmless_words.toml");
  EXPECT_FALSE(HarmlessWords::load(folder.path()));
}

}  // namespace
}  // namespace trocar::dicom::detail
