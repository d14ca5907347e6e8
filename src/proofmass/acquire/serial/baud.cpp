// <asm/termbits.h>, which has rates without a name, conflicts with <termios.h>.
#include <asm/termbits.h>
#include <sys/ioctl.h>

#include "proofmass/acquire/serial/port.hpp"

namespace proofmass::acquire {

// Source: ioctl_tty(2), TCSETS2; termios(3), BOTHER.
unsigned set_baud(int descriptor, unsigned baud) {
  termios2 settings{};
  if (::ioctl(descriptor, TCGETS2, &settings) != 0) return 0;
  settings.c_cflag &= ~static_cast<tcflag_t>(CBAUD | CBAUD << IBSHIFT);
  settings.c_cflag |= BOTHER | BOTHER << IBSHIFT;
  settings.c_ispeed = baud;
  settings.c_ospeed = baud;
  if (::ioctl(descriptor, TCSETS2, &settings) != 0) return 0;
  if (::ioctl(descriptor, TCGETS2, &settings) != 0) return 0;
  return settings.c_ospeed;
}

}  // namespace proofmass::acquire
