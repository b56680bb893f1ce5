#pragma once

#include <QIcon>

namespace trocar::trainer {

enum class PlayerIcon { kPlay, kPause, kPrevious, kNext };

/// The signs of a player, painted: many fonts have none.
QIcon player_icon(PlayerIcon icon);

}  // namespace trocar::trainer
