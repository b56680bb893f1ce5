#pragma once

#include <QIcon>

namespace trocar::trainer {

enum class PlayerIcon { kPlay, kPause, kPrevious, kNext };

/// Painted icons of a player: many fonts lack them.
QIcon player_icon(PlayerIcon icon);

}  // namespace trocar::trainer
