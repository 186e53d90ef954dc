#include "hid_testbed.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <umockdev.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace trephine::test {

namespace {

std::string hex(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  char two[3];
  for (std::uint8_t byte : bytes) {
    std::snprintf(two, sizeof(two), "%02X", byte);
    text += two;
  }
  return text;
}

std::string four(unsigned value) {
  char text[8];
  std::snprintf(text, sizeof(text), "%04x", value);
  return text;
}

}  // namespace

std::vector<std::uint8_t> plainDescriptor(std::uint16_t usage_page, std::uint16_t usage,
                                          std::uint8_t in_bytes, std::uint8_t out_bytes) {
  const auto low = [](std::uint16_t v) { return std::uint8_t(v & 0xFF); };
  const auto high = [](std::uint16_t v) { return std::uint8_t(v >> 8); };
  std::vector<std::uint8_t> text;
  const auto put = [&text](std::initializer_list<int> bytes) {
    for (int byte : bytes) text.push_back(std::uint8_t(byte));
  };
  put({0x06, low(usage_page), high(usage_page), 0x0A, low(usage), high(usage), 0xA1, 0x01});
  put({0x75, 0x08, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x95, in_bytes, 0x09, 0x01, 0x81, 0x02});
  if (out_bytes > 0) put({0x95, out_bytes, 0x09, 0x02, 0x91, 0x02});
  text.push_back(0xC0);
  return text;
}

bool isOpen(int fd) {
  pollfd node{fd, POLLIN, 0};
  return ::poll(&node, 1, 0) >= 0 && !(node.revents & POLLHUP);
}

std::size_t waitingBytes(int fd) {
  char path[64];
  if (::ptsname_r(fd, path, sizeof(path)) != 0) return 0;
  const int node = ::open(path, O_RDONLY | O_NOCTTY | O_NONBLOCK);
  int bytes = 0;
  if (node < 0 || ::ioctl(node, FIONREAD, &bytes) != 0) bytes = 0;
  if (node >= 0) ::close(node);
  return std::size_t(bytes);
}

HidTestbed::HidTestbed() : bed_(umockdev_testbed_new()) {}

HidTestbed::~HidTestbed() {
  while (!plugged_.empty()) unplug(plugged_.back().fd);
  g_object_unref(bed_);
}

bool HidTestbed::add(const std::string& text) {
  GError* error = nullptr;
  if (umockdev_testbed_add_from_string(bed_, text.c_str(), &error)) return true;
  why_ = error ? error->message : "umockdev gave no reason";
  g_clear_error(&error);
  return false;
}

HidTestbed::Plugged* HidTestbed::find(int fd) {
  for (Plugged& each : plugged_) {
    if (each.fd == fd) return &each;
  }
  return nullptr;
}

int HidTestbed::plugIn(const HidDescription& of, const std::string& port, int interface_number) {
  const int number = next_++;  // umockdev takes a number once
  const std::string usb = "/devices/pci0000:00/0000:00:14.0/usb1/" + port;
  const std::string interface = usb + "/" + port + ":1." + std::to_string(interface_number);
  const std::string folder =
      "0003:" + four(of.vendor) + ":" + four(of.product) + "." + four(unsigned(number) + 1);
  const std::string hid = interface + "/" + folder;
  const std::string raw = hid + "/hidraw/hidraw" + std::to_string(number);
  const std::string node = "/dev/hidraw" + std::to_string(number);
  const std::string id = "0003:0000" + four(of.vendor) + ":0000" + four(of.product);
  const std::string event =
      "HID_ID=" + id + "\nHID_NAME=" + of.name + "\nHID_UNIQ=" + of.serial + "\n";
  const bool first = interface_number == 0;
  if ((first && !add("P: " + usb + "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nA: idVendor=" +
                     four(of.vendor) + "\\n\nA: idProduct=" + four(of.product) +
                     "\\n\nA: manufacturer=Test\\n\nA: product=" + of.name +
                     "\\n\nA: serial=" + of.serial + "\\n\nA: bcdDevice=0100\\n\n")) ||
      !add("P: " + interface +
           "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber=0" +
           std::to_string(interface_number) + "\\n\n") ||
      !add("P: " + hid + "\nE: SUBSYSTEM=hid\nE: HID_ID=" + id + "\nE: HID_NAME=" + of.name +
           "\nE: HID_UNIQ=" + of.serial + "\n")) {
    return -1;
  }
  umockdev_testbed_set_attribute(bed_, ("/sys" + hid).c_str(), "uevent", event.c_str());
  umockdev_testbed_set_attribute_binary(bed_, ("/sys" + hid).c_str(), "report_descriptor",
                                        const_cast<guint8*>(of.report_descriptor.data()),
                                        int(of.report_descriptor.size()));
  if (!add("P: " + raw + "\nN: hidraw" + std::to_string(number) +
           "\nE: SUBSYSTEM=hidraw\nE: DEVNAME=" + node +
           "\nE: MAJOR=240\nE: MINOR=" + std::to_string(number) + "\n")) {
    return -1;
  }
  umockdev_testbed_set_attribute_link(bed_, ("/sys" + raw).c_str(), "device",
                                      ("../../../" + folder).c_str());
  // What hidapi asks when it opens: how long the descriptor is, and the descriptor.
  std::vector<std::uint8_t> size{std::uint8_t(of.report_descriptor.size()), 0, 0, 0};
  std::vector<std::uint8_t> whole = size;
  whole.insert(whole.end(), of.report_descriptor.begin(), of.report_descriptor.end());
  whole.resize(4 + 4096);
  char file[] = "/tmp/trephine-hid-XXXXXX";
  const int written = ::mkstemp(file);
  if (written < 0) return -1;
  ::close(written);
  std::ofstream(file) << "@DEV " << node << "\nHIDIOCGRDESCSIZE 0 " << hex(size)
                      << "\nHIDIOCGRDESC 0 " << hex(whole) << "\n";
  GError* error = nullptr;
  const bool loaded = umockdev_testbed_load_ioctl(bed_, node.c_str(), file, &error);
  ::unlink(file);
  if (!loaded) {
    why_ = error ? error->message : "umockdev took no calls";
    g_clear_error(&error);
    return -1;
  }
  const int fd = umockdev_testbed_get_dev_fd(bed_, node.c_str());
  plugged_.push_back({number, fd, -1, {"/sys" + raw, "/sys" + hid, "/sys" + interface}});
  if (first) plugged_.back().folders.push_back("/sys" + usb);
  return fd;
}

void HidTestbed::unplug(const std::vector<int>& fds) {
  for (int fd : fds) {
    block(fd, false);
    if (find(fd)) ::close(fd);
  }
  for (int fd : fds) {
    Plugged* const of = find(fd);
    if (!of) continue;
    umockdev_testbed_uevent(bed_, of->folders.front().c_str(), "remove");
    for (const std::string& folder : of->folders) {
      umockdev_testbed_remove_device(bed_, folder.c_str());
    }
    plugged_.erase(plugged_.begin() + (of - plugged_.data()));
  }
}

void HidTestbed::block(int fd, bool blocked) {
  Plugged* const of = find(fd);
  if (!of || blocked == (of->held >= 0)) return;
  if (blocked) {
    of->held = ::open(("/dev/hidraw" + std::to_string(of->number)).c_str(), O_RDWR | O_NOCTTY);
    ::tcflow(of->held, TCOOFF);
  } else {
    ::tcflow(of->held, TCOON);
    ::close(of->held);
    of->held = -1;
  }
}

}  // namespace trephine::test
