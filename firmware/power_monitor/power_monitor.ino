// Power monitor of a legged robot: battery voltage, current and energy over a serial line, and the motors' relay.
//
// An INA226 on I2C measures the pack of 7 cells at a shunt (an INA219 ends at 26 V, a full pack has 29.4 V). Every
// 11 ms one line of fixed length is sent, 115200 baud:
//   $PWR,<sequence>,<ms>,<mV>,<mA>,<mWh>,<flags>*<CRC>\r\n
// robot_agent/hardware/power_monitor.py reads it and says what the fields are. Commands end in a newline:
//   HB        the computer is alive; without one for half a second a guarded relay opens
//   GUARD 1   guard the relay from now on (GUARD 0: stop)
//   RELAY 1   close the relay (RELAY 0: open it)
//   PING      answers PONG

#include <Wire.h>

const uint8_t INA226 = 0x40;
const uint8_t REGISTER_CONFIGURATION = 0x00;
const uint8_t REGISTER_SHUNT = 0x01;
const uint8_t REGISTER_BUS = 0x02;
const uint16_t CONFIGURATION = 0x4327;      // 4 averages, 1.1 ms each for shunt and bus, without pause
const float MICROVOLT_PER_BIT = 2.5f;       // of the shunt's register (data sheet)
const uint32_t MICROVOLT_PER_BUS_BIT = 1250; // (data sheet)
const float SHUNT_MICROOHM = 500.0f;        // 0.5 mOhm: 81.92 mV are 163 A

const uint8_t RELAY_PIN = 7;
const uint32_t PERIOD_US = 11111;           // 90 Hz
const uint32_t HEARTBEAT_MS = 500;
const uint8_t FLAG_RELAY_CLOSED = 0x01;
const uint8_t FLAG_SENSOR_MISSING = 0x02;
const float MICROJOULE_PER_MWH = 3.6e6f;

uint16_t sequence = 0;
uint32_t nextUs = 0;
uint32_t lastUs = 0;
uint32_t lastHeartbeatMs = 0;
bool guarded = false;
bool relayClosed = false;
int32_t energyMwh = 0;
float energyRestUj = 0.0f;                  // what is not yet a whole mWh
char command[16];
uint8_t commandLength = 0;

void setRelay(bool closed) {
  relayClosed = closed;
  digitalWrite(RELAY_PIN, closed ? HIGH : LOW);
}

bool writeRegister(uint8_t address, uint16_t value) {
  Wire.beginTransmission(INA226);
  Wire.write(address);
  Wire.write(value >> 8);
  Wire.write(value & 0xFF);
  return Wire.endTransmission() == 0;
}

bool readRegister(uint8_t address, int16_t &value) {
  Wire.beginTransmission(INA226);
  Wire.write(address);
  if (Wire.endTransmission(false) != 0 || Wire.requestFrom(INA226, (uint8_t)2) != 2) {
    return false;
  }
  const uint8_t high = Wire.read();
  value = (int16_t)((uint16_t)high << 8 | Wire.read());
  return true;
}

uint16_t crc16(const char *text) {
  uint16_t crc = 0;
  for (; *text; ++text) {
    crc ^= (uint16_t)(uint8_t)*text << 8;
    for (uint8_t bit = 0; bit < 8; ++bit) {
      crc = crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1;
    }
  }
  return crc;
}

void addEnergy(float watts, uint32_t elapsedUs) {
  energyRestUj += watts * elapsedUs;
  const int32_t whole = (int32_t)(energyRestUj / MICROJOULE_PER_MWH);
  energyMwh += whole;
  energyRestUj -= whole * MICROJOULE_PER_MWH;
}

char signOf(int32_t value) {
  return value < 0 ? '-' : '+';
}

void sendLine(uint32_t millivolts, int32_t milliamperes, bool sensed) {
  char body[52];
  char line[64];
  const uint8_t flags = (relayClosed ? FLAG_RELAY_CLOSED : 0) | (sensed ? 0 : FLAG_SENSOR_MISSING);
  snprintf(body, sizeof body, "PWR,%05u,%010lu,%05lu,%c%06ld,%c%08ld,%02X", sequence++, (unsigned long)millis(),
           (unsigned long)millivolts, signOf(milliamperes), (long)labs(milliamperes), signOf(energyMwh),
           (long)labs(energyMwh), flags);
  snprintf(line, sizeof line, "$%s*%04X\r\n", body, crc16(body));
  Serial.write(line);
}

void obey(const char *text) {
  if (strcmp(text, "HB") == 0) {
    lastHeartbeatMs = millis();
  } else if (strcmp(text, "PING") == 0) {
    Serial.write("PONG\r\n");
  } else if (strcmp(text, "RELAY 1") == 0) {
    lastHeartbeatMs = millis();
    setRelay(true);
  } else if (strcmp(text, "RELAY 0") == 0) {
    setRelay(false);
  } else if (strcmp(text, "GUARD 1") == 0) {
    lastHeartbeatMs = millis();
    guarded = true;
  } else if (strcmp(text, "GUARD 0") == 0) {
    guarded = false;
  }
}

void listen() {
  while (Serial.available()) {
    const char letter = Serial.read();
    if (letter == '\n' || letter == '\r') {
      command[commandLength] = '\0';
      obey(command);
      commandLength = 0;
    } else if (commandLength < sizeof command - 1) {
      command[commandLength++] = letter;
    }
  }
}

void setup() {
  pinMode(RELAY_PIN, OUTPUT);
  setRelay(false);
  Serial.begin(115200);
  Wire.begin();
  Wire.setClock(400000);
  writeRegister(REGISTER_CONFIGURATION, CONFIGURATION);
  lastUs = nextUs = micros();
}

void loop() {
  listen();
  if (guarded && relayClosed && millis() - lastHeartbeatMs > HEARTBEAT_MS) {
    setRelay(false);
  }
  if ((int32_t)(micros() - nextUs) < 0) {
    return;
  }
  nextUs += PERIOD_US;
  const uint32_t nowUs = micros();
  int16_t shunt = 0;
  int16_t bus = 0;
  const bool sensed = readRegister(REGISTER_SHUNT, shunt) && readRegister(REGISTER_BUS, bus);
  const uint32_t millivolts = (uint32_t)(uint16_t)bus * MICROVOLT_PER_BUS_BIT / 1000;
  const float amperes = shunt * MICROVOLT_PER_BIT / SHUNT_MICROOHM;
  if (sensed) {
    addEnergy(millivolts * 1e-3f * amperes, nowUs - lastUs);
  } else {
    writeRegister(REGISTER_CONFIGURATION, CONFIGURATION);
  }
  lastUs = nowUs;
  sendLine(millivolts, (int32_t)(amperes * 1e3f), sensed);
}
