// HID devices that are not there, for the real hidapi: umockdev's, each on a USB port of its own.
// The program has to run under umockdev-wrapper.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

struct _UMockdevTestbed;

namespace trephine::test {

struct HidDescription {
  std::uint16_t vendor = 0, product = 0;
  std::string name, serial;
  std::vector<std::uint8_t> report_descriptor;
};

// A report descriptor of one collection with so many bytes in and out.
std::vector<std::uint8_t> plainDescriptor(std::uint16_t usage_page, std::uint16_t usage,
                                          std::uint8_t in_bytes, std::uint8_t out_bytes);

// Of a node whose firmware's end this is: whether a program has it open, and, then, how many bytes
// of reports in wait there for it.
bool isOpen(int fd);
std::size_t waitingBytes(int fd);

class HidTestbed {
 public:
  HidTestbed();
  ~HidTestbed();
  HidTestbed(const HidTestbed&) = delete;
  HidTestbed& operator=(const HidTestbed&) = delete;

  // Plugs one into `port`, such as "1-2". The end of the firmware: bytes that it writes are reports
  // in, those that it reads are reports out, after their id. -1 and why() where that did not work.
  // A further interface of what is plugged in there already: its number.
  int plugIn(const HidDescription& of, const std::string& port, int interface_number = 0);
  // Takes those with these ends out: reading and writing then fail, and the ends are closed. At
  // once, though umockdev needs some 50 ms for each.
  void unplug(const std::vector<int>& fds);
  void unplug(int fd) { unplug(std::vector<int>{fd}); }
  // Writes to it do not return until they may again.
  void block(int fd, bool blocked);
  const std::string& why() const { return why_; }

 private:
  struct Plugged {
    int number = -1, fd = -1, held = -1;
    std::vector<std::string> folders;  // of the system, the node's first
  };
  Plugged* find(int fd);
  bool add(const std::string& text);

  _UMockdevTestbed* bed_;
  std::vector<Plugged> plugged_;
  std::string why_;
  int next_ = 0;
};

}  // namespace trephine::test
