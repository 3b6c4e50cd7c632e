// An Arduino and an INA226 that are not there, to run the power monitor's sketch on a computer.
// usage: sketch RUN_US COMMANDS_US COMMANDS: runs so long, COMMANDS arrive after COMMANDS_US; prints what it sends.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

constexpr int OUTPUT = 1, HIGH = 1, LOW = 0;
static uint64_t nowUs = 4290000000ULL;  // the 32-bit counters begin anew 5 s later
static int relay = -1;
uint32_t micros() { return (uint32_t)nowUs; }
uint32_t millis() { return (uint32_t)(nowUs / 1000); }
void pinMode(int, int) {}
void digitalWrite(int, int value) { relay = value; }

struct FakeSerial {
  std::string coming;
  void begin(long) {}
  int available() { return (int)coming.size(); }
  char read() {
    char letter = coming.front();
    coming.erase(0, 1);
    return letter;
  }
  void write(const char *text) { std::fputs(text, stdout); }
} Serial;

struct FakeWire {
  uint8_t pointer = 0, sent = 0;
  int given = 0;
  void begin() {}
  void setClock(long) {}
  void beginTransmission(uint8_t) { sent = 0; }
  void write(uint8_t value) {
    if (sent++ == 0) pointer = value;
  }
  uint8_t endTransmission(bool = true) { return 0; }
  uint8_t requestFrom(uint8_t, uint8_t count) {
    given = 0;
    return count;
  }
  uint8_t read() {
    // 25.9 V on the bus; 2 mV at 0.5 mOhm are 4 A.
    const uint16_t value = pointer == 2 ? 20720 : 800;
    return given++ == 0 ? value >> 8 : value & 0xFF;
  }
} Wire;

#include "power_monitor.ino"

int main(int, char **arguments) {
  const uint64_t end = nowUs + std::strtoull(arguments[1], nullptr, 10);
  const uint64_t spoken = nowUs + std::strtoull(arguments[2], nullptr, 10);
  bool said = false;
  setup();
  for (; nowUs < end; nowUs += 100) {
    if (!said && nowUs >= spoken) {
      Serial.coming = arguments[3];
      said = true;
    }
    loop();
  }
  return 0;
}
