#!/usr/bin/env bash
# The tests of crates/gpu need a Vulkan device. Where there is none this installs Mesa's software device (Debian and
# Ubuntu, as root), or says what to install.
set -euo pipefail

drivers() { compgen -G '/usr/share/vulkan/icd.d/*.json' || compgen -G '/etc/vulkan/icd.d/*.json'; }
loader() { ldconfig -p 2>/dev/null | grep -q 'libvulkan\.so\.1'; }

if drivers >/dev/null && loader; then
    exit 0
fi
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends mesa-vulkan-drivers libvulkan1 >/dev/null
    exit 0
fi
cat >&2 <<'TEXT'
There is no Vulkan device here, and the tests of crates/gpu need one. Install a driver, or Mesa's software device:
    Debian, Ubuntu: sudo apt-get install mesa-vulkan-drivers libvulkan1
    Fedora:         sudo dnf install mesa-vulkan-drivers vulkan-loader
    Arch:           sudo pacman -S vulkan-swrast vulkan-icd-loader
TEXT
exit 1
