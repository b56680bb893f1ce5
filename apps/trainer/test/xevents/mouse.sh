# The mouse alone. Places are pixels of the window at 1280x800.
drag() { xdotool mousemove "$1" "$2" mousedown 1 && sleep 0.2 && xdotool mousemove "$3" "$4" && sleep 0.2 && xdotool mouseup 1; }

shot start
click 150 258 # the task
click 403 300 # the patient
click 966 232 # guided
shot chosen
click 1210 725 # Start
seen 1-briefing
shot briefing
click 1208 719 # Begin
seen 2-ready
shot ready

drag 500 260 540 280 # the transducer glides over the skin
shot glided
click 120 137 # Move to planned position
seen 2-found
click 44 69 # Needle
click 120 137
seen 2-aimed
click 1164 55 # Controls
shot controls
move 1060 336 # over the choice of the transducer: nothing is chosen, the controls scroll
wheel down 1
move 1066 431 # over a slider: its value stays
wheel down 1
shot controls-scrolled
click 1164 55

into_the_body() { move 500 260 && wheel up 2; }
until_seen 3-inside into_the_body
click 1197 777 # STOP FORCES
seen 4-stopped
shot stopped
click 1197 777 # RESUME FORCES
seen 5-on-again
move 500 260
until_seen 6-near wheel up 1
slow_push() { wheel up 1 && sleep 0.5; }
until_seen 7-at-target slow_push
click 122 683 # Fire the gun
seen 8-fired
shot fired
move 500 260
until_seen 9-out wheel down 2
click 122 724 # End the attempt
shot asked
click 126 675 # End
seen 10-feedback
shot feedback
