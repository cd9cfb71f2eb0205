#!/usr/bin/env bash
# Makes sure that there is a Vulkan device for the tests of crates/gpu: installs Mesa's software device where there is
# none (Debian and Ubuntu, as root), or says what to install.
set -euo pipefail

if [ $# -gt 0 ]; then
    echo "Usage: tools/software-device.sh"
    echo "Installs Mesa's software Vulkan device (lavapipe) on Debian and Ubuntu, as root, if no Vulkan device is there."
    case $1 in -h | --help) exit 0 ;; *) exit 2 ;; esac
fi

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
No Vulkan device was found. Install a graphics driver, or Mesa's software device:
    Debian, Ubuntu: sudo apt-get install mesa-vulkan-drivers libvulkan1
    Fedora:         sudo dnf install mesa-vulkan-drivers vulkan-loader
    Arch:           sudo pacman -S vulkan-swrast vulkan-icd-loader
TEXT
exit 1
