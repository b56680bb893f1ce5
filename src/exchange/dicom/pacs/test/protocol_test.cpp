// Parsers of what a PACS sends, and of addresses.
#include <gtest/gtest.h>

#include "dicom/pacs/detail/data_set.h"
#include "dicom/pacs/detail/dimse_command.h"
#include "dicom/pacs/detail/http_client.h"
#include "dicom/pacs/detail/rewrite_object.h"
#include "dicom/pacs/dicomweb_source.h"
#include "dicom/pacs/dimse_source.h"

namespace trocar::dicom::detail {
namespace {

TEST(DimseCommand, RoundTrips) {
  DimseCommand command;
  command.field = DimseField::kMoveResponse;
  command.sop_class = "1.2.840.10008.5.1.4.1.2.2.2";
  command.sop_instance = "1.2.3";
  command.responded_id = 7;
  command.status = 0xa801;
  const auto read = decode_command(encode(command));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->field, command.field);
  EXPECT_EQ(read->sop_class, command.sop_class);
  EXPECT_EQ(read->sop_instance, command.sop_instance);
  EXPECT_EQ(read->responded_id, command.responded_id);
  EXPECT_EQ(read->status, command.status);
  EXPECT_FALSE(read->message_id);
  EXPECT_FALSE(read->has_data);
}

TEST(DimseCommand, RefusesOtherBytes) {
  DimseCommand command;
  command.message_id = 1;
  const std::string bytes = encode(command);
  for (std::size_t size = 0; size + 8 < bytes.size(); ++size) {
    const auto read = decode_command(bytes.substr(0, size));
    EXPECT_TRUE(!read || read->field == DimseField::kEcho);
  }
  EXPECT_FALSE(decode_command(std::string(100, '\xff')));
  EXPECT_FALSE(decode_command(""));
}

TEST(Query, AnswerIsReadByTag) {
  const std::string bytes = series_query("1.2.3", {});
  EXPECT_EQ(series_of({bytes, {}, {}}).uid, "");
  EXPECT_FALSE(series_of({bytes, {}, {}}).images) << "not counted";
  EXPECT_EQ(study_of({bytes, {}, {}}).uid, "1.2.3");
}

TEST(Query, SanitisesPacsTextToOneLine) {
  EXPECT_EQ(shown_text("a\x1b[31mb\nc"), "a [31mb c") << "no escape sequences in a terminal";
  EXPECT_EQ(shown_text("B\xe4uch"), "B\xc3\xa4uch") << "ISO 8859-1";
  EXPECT_EQ(shown_text("B\xc3\xa4uch"), "B\xc3\xa4uch") << "UTF-8";
  EXPECT_EQ(shown_text("\xc2\x9b"), " ") << "a control character of 8 bits";
}

TEST(StorageClasses, UncompressedIsPreferred) {
  const std::vector<std::string> offered = {"1.2.840.10008.1.2.4.90", "1.2.840.10008.1.2", "1.2.840.10008.1.2.1"};
  EXPECT_EQ(preferred_transfer_syntax(offered), "1.2.840.10008.1.2.1");
  EXPECT_EQ(preferred_transfer_syntax(std::vector<std::string>{"1.2.840.10008.1.2.4.100"}), "") << "a video";
  EXPECT_LE(storage_offers().size(), 127U) << "one of 128 is for the request";
}

/// Notes what arrives.
class NotingSink final : public ObjectSink {
 public:
  Status begin() override {
    objects.emplace_back();
    return {};
  }
  Status append(std::string_view bytes) override {
    objects.back() += bytes;
    return {};
  }
  Status end(const std::string&) override {
    ++ended;
    return {};
  }
  bool is_cancelled() const override { return false; }

  std::vector<std::string> objects;
  std::size_t ended = 0;
};

const std::string kContent =
    "preamble\r\n--b\r\nContent-Type: "
    "application/dicom\r\n\r\nfirst\r\n-\r\n--\r\n--b\r\n\r\nsecond\r\n--b--\r\nepilogue";

TEST(Multipart, ParsesChunksOfAnySize) {
  for (std::size_t piece = 1; piece <= kContent.size(); ++piece) {
    NotingSink sink;
    MultipartReader reader("b", sink);
    for (std::size_t at = 0; at < kContent.size(); at += piece)
      ASSERT_TRUE(reader.push(std::string_view(kContent).substr(at, piece)));
    EXPECT_TRUE(reader.finish());
    EXPECT_EQ(sink.objects, (std::vector<std::string>{"first\r\n-\r\n--", "second"})) << piece;
    EXPECT_EQ(sink.ended, 2U);
  }
}

TEST(Multipart, MissingEndIsAnError) {
  const std::size_t end = kContent.find("--b--") + 4;
  for (std::size_t size = 0; size < end; ++size) {
    NotingSink sink;
    MultipartReader reader("b", sink);
    ASSERT_TRUE(reader.push(std::string_view(kContent).substr(0, size)));
    EXPECT_FALSE(reader.finish()) << size;
  }
}

TEST(Multipart, EndlessHeaderIsRefused) {
  NotingSink sink;
  MultipartReader reader("b", sink);
  ASSERT_TRUE(reader.push("--b\r\n"));
  Status status;
  for (int n = 0; status && n < 100; ++n) status = reader.push(std::string(1000, 'x'));
  EXPECT_FALSE(status);
}

TEST(Multipart, BoundaryIsReadFromTheContentType) {
  EXPECT_EQ(multipart_boundary("multipart/related; type=\"application/dicom\"; boundary=abc"), "abc");
  EXPECT_EQ(multipart_boundary("Multipart/Related; Boundary=\"a b\"; type=x"), "a b");
  EXPECT_FALSE(multipart_boundary("application/json"));
  EXPECT_FALSE(multipart_boundary("multipart/related; boundary="));
  EXPECT_FALSE(multipart_boundary("multipart/related; boundary=" + std::string(71, 'x')));
}

TEST(PacsAddress, HasTitleHostAndPort) {
  const auto options = parse_pacs_address("ORTHANC@pacs.example:4242");
  ASSERT_TRUE(options);
  EXPECT_EQ(options->called_title, "ORTHANC");
  EXPECT_EQ(options->host, "pacs.example");
  EXPECT_EQ(options->port, 4242);
  for (const char* wrong : {"", "pacs:104", "A@:104", "A@pacs", "A@pacs:0", "A@pacs:65536", "A@pacs:x", "@pacs:104",
                            "A TITLE OF MORE THAN 16@pacs:104", "A@p q:104", "A@a:b:104"}) {
    const auto refused = parse_pacs_address(wrong);
    ASSERT_FALSE(refused) << wrong;
    EXPECT_EQ(refused.error().exit_status, 2) << wrong;
  }
}

TEST(DicomWebUrl, HasSchemeHostPortAndPath) {
  const auto url = parse_dicomweb_url("https://pacs.example/dicom-web/");
  ASSERT_TRUE(url);
  EXPECT_TRUE(url->is_secure);
  EXPECT_EQ(url->host, "pacs.example");
  EXPECT_EQ(url->port, 443);
  EXPECT_EQ(url->path, "/dicom-web");
  EXPECT_EQ(parse_dicomweb_url("http://[::1]:8042")->host, "::1");
  EXPECT_EQ(parse_dicomweb_url("http://[::1]:8042")->port, 8042);
  for (const char* wrong : {"", "pacs.example", "ftp://x", "http://", "http://:80", "http://x:0", "http://x:99999",
                            "http://me:secret@x/", "http://x/a b", "http://x/?q=1"}) {
    const auto refused = parse_dicomweb_url(wrong);
    ASSERT_FALSE(refused) << wrong;
    EXPECT_EQ(refused.error().exit_status, 2) << wrong;
    EXPECT_EQ(refused.error().text().find("secret"), std::string::npos) << "a password must not be repeated";
  }
}

}  // namespace
}  // namespace trocar::dicom::detail
