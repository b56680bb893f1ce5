<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de_DE" sourcelanguage="en">
<context>
    <name>Action</name>
    <message>
        <source>select the needle</source>
        <translation>Nadel auswählen</translation>
    </message>
    <message>
        <source>select the transducer</source>
        <translation>Schallkopf auswählen</translation>
    </message>
    <message>
        <source>select the palpating finger</source>
        <translation>Tastfinger auswählen</translation>
    </message>
    <message>
        <source>select no tool: the mouse rotates the view</source>
        <translation>kein Instrument auswählen: die Maus dreht die Ansicht</translation>
    </message>
    <message>
        <source>drag; arrow keys</source>
        <translation>Ziehen; Pfeiltasten</translation>
    </message>
    <message>
        <source>move the tool along the skin</source>
        <translation>Instrument auf der Haut bewegen</translation>
    </message>
    <message>
        <source>right drag; Shift + arrow keys</source>
        <translation>Ziehen mit rechter Taste; Umschalt + Pfeiltasten</translation>
    </message>
    <message>
        <source>tilt the tool</source>
        <translation>Instrument kippen</translation>
    </message>
    <message>
        <source>Shift + right drag</source>
        <translation>Umschalt + Ziehen mit rechter Taste</translation>
    </message>
    <message>
        <source>turn the tool about its axis</source>
        <translation>Instrument um seine Achse drehen</translation>
    </message>
    <message>
        <source>wheel; Page up, Page down</source>
        <translation>Mausrad; Bild auf, Bild ab</translation>
    </message>
    <message>
        <source>advance or withdraw the needle; press the transducer harder or softer</source>
        <translation>Nadel vorschieben oder zurückziehen; Schallkopf stärker oder schwächer andrücken</translation>
    </message>
    <message>
        <source>Shift + wheel; Shift + Page up, Page down</source>
        <translation>Umschalt + Mausrad; Umschalt + Bild auf, Bild ab</translation>
    </message>
    <message>
        <source>the same in steps of 0.1 mm</source>
        <translation>ebenso in Schritten von 0,1 mm</translation>
    </message>
    <message>
        <source>Ctrl + drag</source>
        <translation>Strg + Ziehen</translation>
    </message>
    <message>
        <source>rotate the view while a tool is selected</source>
        <translation>Ansicht drehen, während ein Instrument ausgewählt ist</translation>
    </message>
    <message>
        <source>move the tool to its planned position (guided attempts)</source>
        <translation>Instrument an die geplante Position bewegen (angeleitete Versuche)</translation>
    </message>
    <message>
        <source>hold the tool in place, or release it</source>
        <translation>Instrument fixieren oder lösen</translation>
    </message>
    <message>
        <source>fire the biopsy gun</source>
        <translation>Biopsiepistole auslösen</translation>
    </message>
    <message>
        <source>take the core out and load the biopsy gun</source>
        <translation>Stanzzylinder entnehmen und Biopsiepistole spannen</translation>
    </message>
    <message>
        <source>inject local anaesthetic</source>
        <translation>Lokalanästhetikum injizieren</translation>
    </message>
    <message>
        <source>remove or reinsert the stylet</source>
        <translation>Mandrin ziehen oder wieder einführen</translation>
    </message>
    <message>
        <source>aspirate with a syringe</source>
        <translation>mit einer Spritze aspirieren</translation>
    </message>
    <message>
        <source>advance the guide wire</source>
        <translation>Führungsdraht vorschieben</translation>
    </message>
    <message>
        <source>ask for a breath hold, or let the patient breathe again</source>
        <translation>Patienten den Atem anhalten oder weiteratmen lassen</translation>
    </message>
    <message>
        <source>Z (hold)</source>
        <translation>Z (halten)</translation>
    </message>
    <message>
        <source>fluoroscopy, while the X-ray view is visible</source>
        <translation>Durchleuchtung, solange die Röntgenansicht sichtbar ist</translation>
    </message>
    <message>
        <source>J (hold)</source>
        <translation>J (halten)</translation>
    </message>
    <message>
        <source>inject contrast agent at the needle tip</source>
        <translation>Kontrastmittel an der Nadelspitze injizieren</translation>
    </message>
    <message>
        <source>click; Enter</source>
        <translation>Klick; Enter</translation>
    </message>
    <message>
        <source>mark the skin under the finger</source>
        <translation>Haut unter dem Finger markieren</translation>
    </message>
    <message>
        <source>remove the last mark</source>
        <translation>letzte Markierung entfernen</translation>
    </message>
    <message>
        <source>stop all forces, or switch them on again</source>
        <translation>alle Kräfte abschalten oder wieder einschalten</translation>
    </message>
    <message>
        <source>end and score the attempt; asks for confirmation</source>
        <translation>Versuch beenden und bewerten; mit Rückfrage</translation>
    </message>
    <message>
        <source>answer a question with yes</source>
        <translation>Frage mit Ja beantworten</translation>
    </message>
    <message>
        <source>answer a question with no</source>
        <translation>Frage mit Nein beantworten</translation>
    </message>
    <message>
        <source>play or pause the replay</source>
        <translation>Wiedergabe starten oder anhalten</translation>
    </message>
    <message>
        <source>next event of the replay</source>
        <translation>nächstes Ereignis der Wiedergabe</translation>
    </message>
    <message>
        <source>previous event of the replay</source>
        <translation>vorheriges Ereignis der Wiedergabe</translation>
    </message>
    <message>
        <source>worst moment of the replay</source>
        <translation>kritischster Moment der Wiedergabe</translation>
    </message>
    <message>
        <source>moment of the next hint</source>
        <translation>Moment des nächsten Hinweises</translation>
    </message>
    <message>
        <source>try again; after an exam, begin another</source>
        <translation>noch einmal versuchen; nach einer Prüfung eine weitere beginnen</translation>
    </message>
    <message>
        <source>back to the start page</source>
        <translation>zurück zur Startseite</translation>
    </message>
    <message>
        <source>save the report of the attempt</source>
        <translation>Bericht des Versuchs speichern</translation>
    </message>
    <message>
        <source>Ctrl+1, Ctrl+2 …</source>
        <translation>Strg+1, Strg+2 …</translation>
    </message>
    <message>
        <source>layout of the views</source>
        <translation>Anordnung der Ansichten</translation>
    </message>
    <message>
        <source>show or hide the X-ray view</source>
        <translation>Röntgenansicht ein- oder ausblenden</translation>
    </message>
    <message>
        <source>freeze the ultrasound image</source>
        <translation>Ultraschallbild einfrieren</translation>
    </message>
    <message>
        <source>automatic ultrasound gain</source>
        <translation>automatische Ultraschallverstärkung</translation>
    </message>
    <message>
        <source>more ultrasound gain</source>
        <translation>mehr Ultraschallverstärkung</translation>
    </message>
    <message>
        <source>less ultrasound gain</source>
        <translation>weniger Ultraschallverstärkung</translation>
    </message>
    <message>
        <source>more ultrasound depth</source>
        <translation>mehr Ultraschalltiefe</translation>
    </message>
    <message>
        <source>less ultrasound depth</source>
        <translation>weniger Ultraschalltiefe</translation>
    </message>
    <message>
        <source>tissue harmonic imaging (THI)</source>
        <translation>harmonische Bildgebung (THI)</translation>
    </message>
    <message>
        <source>colour Doppler</source>
        <translation>Farbdoppler</translation>
    </message>
    <message>
        <source>M, then two clicks or a drag</source>
        <translation>M, dann zwei Klicks oder Ziehen</translation>
    </message>
    <message>
        <source>measure a distance in the ultrasound image; its ends can be dragged later</source>
        <translation>Abstand im Ultraschallbild messen; die Endpunkte lassen sich später verschieben</translation>
    </message>
    <message>
        <source>show or hide the image controls beside the ultrasound image</source>
        <translation>Bildregler neben dem Ultraschallbild ein- oder ausblenden</translation>
    </message>
    <message>
        <source>tissue parameters and the predicted force</source>
        <translation>Gewebeparameter und vorhergesagte Kraft</translation>
    </message>
    <message>
        <source>case builder: create cases from CT and labels</source>
        <translation>Fall-Editor: Fälle aus CT und Labels erstellen</translation>
    </message>
    <message>
        <source>all keys and mouse actions</source>
        <translation>alle Tasten und Mausaktionen</translation>
    </message>
    <message>
        <source>mirror the window, or not</source>
        <translation>Spiegelung des Fensters ein- oder ausschalten</translation>
    </message>
    <message>
        <source>full screen</source>
        <translation>Vollbild</translation>
    </message>
    <message>
        <source>larger text</source>
        <translation>größere Schrift</translation>
    </message>
    <message>
        <source>smaller text</source>
        <translation>kleinere Schrift</translation>
    </message>
    <message>
        <source>open the case and show the briefing</source>
        <translation>Fall öffnen und Einweisung anzeigen</translation>
    </message>
    <message>
        <source>select the proposed exercise and open the case</source>
        <translation>vorgeschlagene Übung auswählen und Fall öffnen</translation>
    </message>
    <message>
        <source>open a patient folder</source>
        <translation>Patientenordner öffnen</translation>
    </message>
    <message>
        <source>begin the attempt</source>
        <translation>Versuch beginnen</translation>
    </message>
    <message>
        <source>back to the start page; stops opening the case</source>
        <translation>zurück zur Startseite; bricht das Öffnen des Falls ab</translation>
    </message>
    <message>
        <source>1 … 6</source>
        <translation>1 … 6</translation>
    </message>
    <message>
        <source>look from the front, obliquely, from the right, left, back, head</source>
        <translation>Blick von vorn, schräg, von rechts, von links, von hinten, vom Kopf her</translation>
    </message>
    <message>
        <source>rotate the view</source>
        <translation>Ansicht drehen</translation>
    </message>
    <message>
        <source>wheel; +, −</source>
        <translation>Mausrad; +, −</translation>
    </message>
    <message>
        <source>zoom in, out</source>
        <translation>vergrößern, verkleinern</translation>
    </message>
    <message>
        <source>follow the needle tip</source>
        <translation>der Nadelspitze folgen</translation>
    </message>
    <message>
        <source>look along the needle</source>
        <translation>entlang der Nadel blicken</translation>
    </message>
    <message>
        <source>look from beside the needle</source>
        <translation>von der Seite auf die Nadel blicken</translation>
    </message>
    <message>
        <source>show or hide the guidance</source>
        <translation>Zielführung ein- oder ausblenden</translation>
    </message>
    <message>
        <source>show or hide the landmarks</source>
        <translation>Landmarken ein- oder ausblenden</translation>
    </message>
    <message>
        <source>reset the view</source>
        <translation>Ansicht zurücksetzen</translation>
    </message>
    <message>
        <source>click; arrow keys</source>
        <translation>Klick; Pfeiltasten</translation>
    </message>
    <message>
        <source>move the crosshairs</source>
        <translation>Fadenkreuz bewegen</translation>
    </message>
    <message>
        <source>Shift + arrow keys</source>
        <translation>Umschalt + Pfeiltasten</translation>
    </message>
    <message>
        <source>the same by 10 mm</source>
        <translation>ebenso um 10 mm</translation>
    </message>
    <message>
        <source>next, previous slice</source>
        <translation>nächster, vorheriger Schnitt</translation>
    </message>
    <message>
        <source>Ctrl + wheel; +, −</source>
        <translation>Strg + Mausrad; +, −</translation>
    </message>
    <message>
        <source>1 … 5</source>
        <translation>1 … 5</translation>
    </message>
    <message>
        <source>CT window</source>
        <translation>CT-Fenster</translation>
    </message>
    <message>
        <source>reset the slice</source>
        <translation>Schnitt zurücksetzen</translation>
    </message>
    <message>
        <source>show or hide the labels</source>
        <translation>Labels ein- oder ausblenden</translation>
    </message>
    <message>
        <source>wheel; arrow keys</source>
        <translation>Mausrad; Pfeiltasten</translation>
    </message>
    <message>
        <source>previous, next image of the frozen cine loop</source>
        <translation>vorheriges, nächstes Bild des eingefrorenen Cine-Loops</translation>
    </message>
    <message>
        <source>play the frozen cine loop</source>
        <translation>eingefrorenen Cine-Loop abspielen</translation>
    </message>
    <message>
        <source>magnify the image</source>
        <translation>Bild vergrößern</translation>
    </message>
    <message>
        <source>whole image</source>
        <translation>ganzes Bild</translation>
    </message>
    <message>
        <source>delete the selected caliper, else the last one</source>
        <translation>ausgewählte Messung löschen, sonst die letzte</translation>
    </message>
    <message>
        <source>stop measuring</source>
        <translation>Messen beenden</translation>
    </message>
    <message>
        <source>plot over depth or time</source>
        <translation>Kurve über Tiefe oder Zeit</translation>
    </message>
    <message>
        <source>back, forward</source>
        <translation>zurück, vor</translation>
    </message>
    <message>
        <source>further back, forward</source>
        <translation>weiter zurück, vor</translation>
    </message>
    <message>
        <source>start of the replay</source>
        <translation>Anfang der Wiedergabe</translation>
    </message>
    <message>
        <source>end of the replay</source>
        <translation>Ende der Wiedergabe</translation>
    </message>
    <message>
        <source>&lt;, &gt;</source>
        <translation>&lt;, &gt;</translation>
    </message>
    <message>
        <source>slower, faster</source>
        <translation>langsamer, schneller</translation>
    </message>
    <message>
        <source>undo a change of an opacity, a tissue parameter or a caliper</source>
        <translation>Änderung einer Deckkraft, eines Gewebeparameters oder einer Messung rückgängig machen</translation>
    </message>
    <message>
        <source>redo it</source>
        <translation>wiederholen</translation>
    </message>
    <message>
        <source>Alt+1 … Alt+7</source>
        <translation>Alt+1 … Alt+7</translation>
    </message>
    <message>
        <source>go to a step of the case</source>
        <translation>zu einem Schritt des Falls gehen</translation>
    </message>
    <message>
        <source>undo the last step</source>
        <translation>letzten Schritt rückgängig machen</translation>
    </message>
    <message>
        <source>click the target in a slice, or double-click it in 3D</source>
        <translation>Ziel in einem Schnitt anklicken oder in 3D doppelklicken</translation>
    </message>
    <message>
        <source>click a landmark in a slice, or double-click it in 3D; click again to move it</source>
        <translation>Landmarke in einem Schnitt anklicken oder in 3D doppelklicken; ein weiterer Klick verschiebt sie</translation>
    </message>
    <message>
        <source>click a landmark pair in the CT and in the ultrasound</source>
        <translation>Landmarkenpaar im CT und im Ultraschall anklicken</translation>
    </message>
    <message>
        <source>mark the entry zone</source>
        <translation>Einstichzone markieren</translation>
    </message>
    <message>
        <source>plan the path</source>
        <translation>Weg planen</translation>
    </message>
    <message>
        <source>click the entry of the path</source>
        <translation>Einstichstelle des Weges anklicken</translation>
    </message>
    <message>
        <source>click the goal of the path</source>
        <translation>Endpunkt des Weges anklicken</translation>
    </message>
    <message>
        <source>save the case</source>
        <translation>Fall speichern</translation>
    </message>
    <message>
        <source>Enter</source>
        <translation>Enter</translation>
    </message>
    <message>
        <source>Everywhere</source>
        <translation>Überall</translation>
    </message>
    <message>
        <source>Start page</source>
        <translation>Startseite</translation>
    </message>
    <message>
        <source>Briefing</source>
        <translation>Einweisung</translation>
    </message>
    <message>
        <source>Puncture</source>
        <translation>Punktion</translation>
    </message>
    <message>
        <source>Puncture and feedback</source>
        <translation>Punktion und Auswertung</translation>
    </message>
    <message>
        <source>Feedback</source>
        <translation>Auswertung</translation>
    </message>
    <message>
        <source>Case builder</source>
        <translation>Fall-Editor</translation>
    </message>
    <message>
        <source>3D view with the focus</source>
        <translation>3D-Ansicht mit Fokus</translation>
    </message>
    <message>
        <source>Slice with the focus</source>
        <translation>Schnitt mit Fokus</translation>
    </message>
    <message>
        <source>Ultrasound image with the focus</source>
        <translation>Ultraschallbild mit Fokus</translation>
    </message>
    <message>
        <source>Force plot with the focus</source>
        <translation>Kraftkurve mit Fokus</translation>
    </message>
    <message>
        <source>Time line with the focus</source>
        <translation>Zeitleiste mit Fokus</translation>
    </message>
    <message>
        <source>Panel with the focus</source>
        <translation>Bereich mit Fokus</translation>
    </message>
</context>
<context>
    <name>AttemptWords</name>
    <message>
        <source>starting</source>
        <translation>wird gestartet</translation>
    </message>
    <message>
        <source>interrupted</source>
        <translation>unterbrochen</translation>
    </message>
    <message>
        <source>forces stopped</source>
        <translation>Kräfte angehalten</translation>
    </message>
    <message>
        <source>being scored</source>
        <translation>wird bewertet</translation>
    </message>
    <message>
        <source>outside</source>
        <translation>außerhalb</translation>
    </message>
    <message>
        <source>pressing</source>
        <translation>drückt</translation>
    </message>
    <message>
        <source>in the body</source>
        <translation>im Körper</translation>
    </message>
    <message>
        <source>pulling back</source>
        <translation>wird zurückgezogen</translation>
    </message>
</context>
<context>
    <name>BriefingPicture</name>
    <message>
        <source>Axial</source>
        <translation>Axial</translation>
    </message>
    <message>
        <source>Sagittal</source>
        <translation>Sagittal</translation>
    </message>
    <message>
        <source>Along the planned path</source>
        <translation>Entlang des geplanten Weges</translation>
    </message>
    <message>
        <source>%1 and others</source>
        <translation>%1 und andere</translation>
    </message>
</context>
<context>
    <name>BriefingText</name>
    <message>
        <source>not stated</source>
        <translation>keine Angabe</translation>
    </message>
    <message>
        <source>&lt;b&gt;%1&lt;/b&gt;, %2, %3 years, %4 cm, %5 kg (BMI %6)</source>
        <translation>&lt;b&gt;%1&lt;/b&gt;, %2, %3 Jahre, %4 cm, %5 kg (BMI %6)</translation>
    </message>
    <message>
        <source>female</source>
        <translation>weiblich</translation>
    </message>
    <message>
        <source>male</source>
        <translation>männlich</translation>
    </message>
    <message>
        <source>%1 × %2 × %3 mm</source>
        <translation>%1 × %2 × %3 mm</translation>
    </message>
    <message>
        <source>lesion of %1 (right–left, front–back, head–feet)</source>
        <translation>Herd von %1 (rechts–links, vorn–hinten, kopf–fußwärts)</translation>
    </message>
    <message>
        <source>%1 in segment %2 of the %3</source>
        <translation>%1, Segment %2, %3</translation>
    </message>
    <message>
        <source>%1; middle %2 mm below the nearest skin</source>
        <translation>%1; Mitte %2 mm unter der nächsten Haut</translation>
    </message>
    <message>
        <source>Bring the needle&apos;s tip into the spinal fluid of the dural sac.</source>
        <translation>Bringen Sie die Nadelspitze in den Liquor des Duralsacks.</translation>
    </message>
    <message>
        <source>Bring the needle&apos;s tip into the free fluid of the abdomen.</source>
        <translation>Bringen Sie die Nadelspitze in die freie Flüssigkeit des Bauchraums.</translation>
    </message>
    <message>
        <source>Bring the needle&apos;s tip into a bile duct of the liver.</source>
        <translation>Bringen Sie die Nadelspitze in einen Gallengang der Leber.</translation>
    </message>
    <message>
        <source>Bring the needle&apos;s tip to the lesion of the %1; without a lesion, to its healthy tissue.</source>
        <translation>Bringen Sie die Nadelspitze zum Herd (Organ: %1), ohne Herd in gesundes Gewebe.</translation>
    </message>
    <message>
        <source>Bring the needle&apos;s tip to the healthy tissue of the %1.</source>
        <translation>Bringen Sie die Nadelspitze in gesundes Gewebe (Organ: %1).</translation>
    </message>
    <message>
        <source>Bring the needle&apos;s tip to the lesion of the %1.</source>
        <translation>Bringen Sie die Nadelspitze zum Herd (Organ: %1).</translation>
    </message>
    <message>
        <source>ultrasound</source>
        <translation>Ultraschall</translation>
    </message>
    <message>
        <source>fluoroscopy (X-ray)</source>
        <translation>Durchleuchtung (Röntgen)</translation>
    </message>
    <message>
        <source>palpation of the landmarks</source>
        <translation>Tasten der Landmarken</translation>
    </message>
    <message>
        <source>%1; %2 mm thick</source>
        <translation>%1; %2 mm dick</translation>
    </message>
    <message>
        <source>, notch of %1 mm; the stylet shoots %2 mm beyond the tip</source>
        <translation>, Kerbe von %1 mm; der Mandrin schießt %2 mm über die Spitze hinaus</translation>
    </message>
    <message>
        <source>%1. %2</source>
        <translation>%1. %2</translation>
    </message>
    <message>
        <source>half of the points at %1%2</source>
        <translation>die Hälfte der Punkte bei %1%2</translation>
    </message>
    <message>
        <source>one needless puncture or shot halves the points</source>
        <translation>eine unnötige Punktion oder Auslösung halbiert die Punkte</translation>
    </message>
    <message>
        <source>none from %1 s on</source>
        <translation>keine ab %1 s</translation>
    </message>
    <message>
        <source>none from %1 Gy cm² on</source>
        <translation>keine ab %1 Gy cm²</translation>
    </message>
    <message>
        <source>one of them halves the points</source>
        <translation>eines davon halbiert die Punkte</translation>
    </message>
    <message>
        <source>%1 comes back</source>
        <translation>%1 fließt zurück</translation>
    </message>
    <message>
        <source>none with major harm, minor harm costs 40 %</source>
        <translation>keine bei großem Schaden, kleiner Schaden kostet 40 %</translation>
    </message>
    <message>
        <source>needle</source>
        <translation>Nadel</translation>
    </message>
    <message>
        <source>transducer</source>
        <translation>Schallkopf</translation>
    </message>
    <message>
        <source>cap</source>
        <translation>Kappe</translation>
    </message>
    <message>
        <source>push and turn it to move and turn the %1</source>
        <translation>drücken und drehen bewegt und dreht: %1</translation>
    </message>
    <message>
        <source>its stylus is the %1</source>
        <translation>sein Griff führt: %1</translation>
    </message>
    <message>
        <source>Patient</source>
        <translation>Patient</translation>
    </message>
    <message>
        <source>Indication</source>
        <translation>Indikation</translation>
    </message>
    <message>
        <source>Coagulation</source>
        <translation>Gerinnung</translation>
    </message>
    <message>
        <source>Allergies</source>
        <translation>Allergien</translation>
    </message>
    <message>
        <source>Posture</source>
        <translation>Lagerung</translation>
    </message>
    <message>
        <source>Description</source>
        <translation>Beschreibung</translation>
    </message>
    <message>
        <source>Finding</source>
        <translation>Befund</translation>
    </message>
    <message>
        <source>no lesion: take healthy tissue of the %1</source>
        <translation>kein Herd: nehmen Sie gesundes Gewebe (Organ: %1)</translation>
    </message>
    <message>
        <source>lesion of the %1</source>
        <translation>Herd (Organ: %1)</translation>
    </message>
    <message>
        <source>Goal</source>
        <translation>Ziel</translation>
    </message>
    <message>
        <source>Guidance</source>
        <translation>Zielführung</translation>
    </message>
    <message>
        <source>Needle</source>
        <translation>Nadel</translation>
    </message>
    <message>
        <source>Steps</source>
        <translation>Schritte</translation>
    </message>
    <message>
        <source>%1 mm long</source>
        <translation>%1 mm lang</translation>
    </message>
    <message>
        <source>, %1 mm of it in the %2</source>
        <translation>, davon %1 mm im Organ (%2)</translation>
    </message>
    <message>
        <source>; nearest structure at risk: %1</source>
        <translation>; nächste Risikostruktur: %1</translation>
    </message>
    <message>
        <source>none</source>
        <translation>keine</translation>
    </message>
    <message>
        <source>Planned path</source>
        <translation>Geplanter Weg</translation>
    </message>
    <message>
        <source>Points</source>
        <translation>Punkte</translation>
    </message>
    <message>
        <source>Passed</source>
        <translation>Bestanden</translation>
    </message>
    <message>
        <source>with %1 of 100 points and the target reached</source>
        <translation>mit %1 von 100 Punkten und erreichtem Ziel</translation>
    </message>
    <message>
        <source>Do not touch</source>
        <translation>Nicht berühren</translation>
    </message>
    <message>
        <source>Not passed</source>
        <translation>Nicht bestanden</translation>
    </message>
    <message>
        <source>whatever the points, after touching: %1</source>
        <translation>bei jeder Punktzahl nach Berührung von: %1</translation>
    </message>
    <message>
        <source>whatever the points: %1</source>
        <translation>bei jeder Punktzahl: %1</translation>
    </message>
</context>
<context>
    <name>ParameterScale</name>
    <message>
        <source>never</source>
        <translation>nie</translation>
    </message>
    <message>
        <source>%1 to %2</source>
        <translation>%1 bis %2</translation>
    </message>
    <message>
        <source>, or never</source>
        <translation> oder nie</translation>
    </message>
</context>
<context>
    <name>PathComparison</name>
    <message>
        <source>Planned path</source>
        <translation>Geplanter Weg</translation>
    </message>
    <message>
        <source>Path %1</source>
        <translation>Weg %1</translation>
    </message>
</context>
<context>
    <name>PatientEntryText</name>
    <message>
        <source>This folder cannot be read</source>
        <translation>Dieser Ordner ist nicht lesbar</translation>
    </message>
    <message>
        <source>difficulty %1 of 5</source>
        <translation>Schwierigkeit %1 von 5</translation>
    </message>
</context>
<context>
    <name>PlannedPosition</name>
    <message>
        <source>Key P: a finger feels for bone. Stuck? Keys A, H: needle to the planned position</source>
        <translation>Taste P: Ein Finger tastet nach Knochen. Kommen Sie nicht weiter? Tasten A, H: Nadel an die geplante Position</translation>
    </message>
    <message>
        <source>Stuck? Keys S, H: transducer to the planned position</source>
        <translation>Kommen Sie nicht weiter? Tasten S, H: Schallkopf an die geplante Position</translation>
    </message>
    <message>
        <source>Stuck? Keys A, H: needle to the planned position</source>
        <translation>Kommen Sie nicht weiter? Tasten A, H: Nadel an die geplante Position</translation>
    </message>
</context>
<context>
    <name>QDialog</name>
    <message>
        <source>Keys and mouse</source>
        <translation>Tastatur und Maus</translation>
    </message>
    <message>
        <source>Filter</source>
        <translation>Filter</translation>
    </message>
    <message>
        <source>Filter: a key, or a word such as stylet</source>
        <translation>Filter: eine Taste oder ein Wort wie Mandrin</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>Schließen</translation>
    </message>
    <message>
        <source>Closes this  (%1)</source>
        <translation>Schließt dieses Fenster  (%1)</translation>
    </message>
</context>
<context>
    <name>QObject</name>
    <message>
        <source>Others at attempt %1: %2 (%3).</source>
        <translation>Andere bei Versuch %1: %2 (%3).</translation>
    </message>
    <message>
        <source>1 person</source>
        <translation>1 Person</translation>
    </message>
    <message>
        <source>%1 people</source>
        <translation>%1 Personen</translation>
    </message>
    <message>
        <source>%1 to %2</source>
        <translation>%1 bis %2</translation>
    </message>
    <message>
        <source>Simulated experts: %1.</source>
        <translation>Simulierte Experten: %1.</translation>
    </message>
    <message>
        <source>Experts: %1.</source>
        <translation>Experten: %1.</translation>
    </message>
    <message>
        <source>No attempt that counts yet.</source>
        <translation>Noch kein gewerteter Versuch.</translation>
    </message>
    <message>
        <source>%1 of %2 attempts passed.</source>
        <translation>%1 von %2 Versuchen bestanden.</translation>
    </message>
    <message>
        <source> Mean of the last %1: %2.</source>
        <translation> Mittelwert der letzten %1: %2.</translation>
    </message>
    <message>
        <source>Your attempt %1: %2 points.</source>
        <translation>Ihr Versuch %1: %2 Punkte.</translation>
    </message>
</context>
<context>
    <name>QWidget</name>
    <message>
        <source>%1  (%2 in this panel)</source>
        <translation>%1  (%2 in diesem Bereich)</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>Rückgängig</translation>
    </message>
    <message>
        <source>Redo</source>
        <translation>Wiederholen</translation>
    </message>
</context>
<context>
    <name>StatusHealthText</name>
    <message>
        <source>Interrupted</source>
        <translation>Unterbrochen</translation>
    </message>
    <message>
        <source>The safety gate of &quot;%1&quot; switched its forces off: %2.</source>
        <translation>Die Sicherheitsstufe von „%1“ hat die Kräfte abgeschaltet: %2.</translation>
    </message>
    <message>
        <source>The server of &quot;%1&quot; is not connected: it is restarted when you resume the forces.</source>
        <translation>Der Server von „%1“ ist nicht verbunden: Er startet neu, wenn Sie die Kräfte fortsetzen.</translation>
    </message>
    <message>
        <source>The server of &quot;%1&quot; is not connected; it is being restarted.</source>
        <translation>Der Server von „%1“ ist nicht verbunden; er wird neu gestartet.</translation>
    </message>
    <message>
        <source>Slow forces</source>
        <translation>Kräfte verspätet</translation>
    </message>
    <message>
        <source>The forces of &quot;%1&quot; are late: the computer is too busy.</source>
        <translation>Die Kräfte von „%1“ kommen zu spät: Der Rechner ist überlastet.</translation>
    </message>
    <message>
        <source>Slow display</source>
        <translation>Anzeige langsam</translation>
    </message>
    <message>
        <source>The display is slow: the computer is too busy.</source>
        <translation>Die Anzeige ist langsam: Der Rechner ist überlastet.</translation>
    </message>
    <message>
        <source>fault: %1</source>
        <translation>Störung: %1</translation>
    </message>
    <message>
        <source>connected</source>
        <translation>verbunden</translation>
    </message>
    <message>
        <source>not connected</source>
        <translation>nicht verbunden</translation>
    </message>
    <message>
        <source>Server</source>
        <translation>Server</translation>
    </message>
    <message>
        <source>Rate</source>
        <translation>Rate</translation>
    </message>
    <message>
        <source>%1 Hz</source>
        <translation>%1 Hz</translation>
    </message>
    <message>
        <source>Periods on time</source>
        <translation>Rechtzeitige Perioden</translation>
    </message>
    <message>
        <source>%1 %</source>
        <translation>%1 %</translation>
    </message>
    <message>
        <source>Lateness, 99 % below</source>
        <translation>Verspätung, 99 % unter</translation>
    </message>
    <message>
        <source>%1 µs</source>
        <translation>%1 µs</translation>
    </message>
    <message>
        <source>Ticks lost</source>
        <translation>Verlorene Ticks</translation>
    </message>
    <message>
        <source>Real-time scheduling</source>
        <translation>Echtzeitpriorität</translation>
    </message>
    <message>
        <source>yes</source>
        <translation>ja</translation>
    </message>
    <message>
        <source>no</source>
        <translation>nein</translation>
    </message>
    <message>
        <source>Granted by the system</source>
        <translation>Vom System gewährt</translation>
    </message>
    <message>
        <source>Forces off</source>
        <translation>Kräfte aus</translation>
    </message>
    <message>
        <source>No attempt is running: forces are off.</source>
        <translation>Kein Versuch läuft: Die Kräfte sind aus.</translation>
    </message>
    <message>
        <source>Starting</source>
        <translation>Startet</translation>
    </message>
    <message>
        <source>The haptic servers start.</source>
        <translation>Die Haptikserver starten.</translation>
    </message>
    <message>
        <source>Stopped</source>
        <translation>Angehalten</translation>
    </message>
    <message>
        <source>The forces are stopped; Space switches them on.</source>
        <translation>Die Kräfte sind angehalten; die Leertaste schaltet sie ein.</translation>
    </message>
    <message>
        <source>Good</source>
        <translation>Gut</translation>
    </message>
    <message>
        <source>Display</source>
        <translation>Anzeige</translation>
    </message>
    <message>
        <source>%1 frames/s</source>
        <translation>%1 Bilder/s</translation>
    </message>
    <message>
        <source>Slowest frame</source>
        <translation>Langsamstes Bild</translation>
    </message>
    <message>
        <source>%1 ms</source>
        <translation>%1 ms</translation>
    </message>
    <message>
        <source>Frames over %1 ms</source>
        <translation>Bilder über %1 ms</translation>
    </message>
    <message>
        <source>%1 of %2 late</source>
        <translation>%1 von %2 verspätet</translation>
    </message>
</context>
<context>
    <name>Table</name>
    <message>
        <source>Guided</source>
        <translation>Angeleitet</translation>
    </message>
    <message>
        <source>Assisted</source>
        <translation>Unterstützt</translation>
    </message>
    <message>
        <source>Exam</source>
        <translation>Prüfung</translation>
    </message>
    <message>
        <source>Expert path, entry zone, target, guide line and hints.</source>
        <translation>Expertenweg, Einstichzone, Ziel, Punktionslinie und Hinweise.</translation>
    </message>
    <message>
        <source>Entry zone, target and hints, without the path.</source>
        <translation>Einstichzone, Ziel und Hinweise, ohne den Weg.</translation>
    </message>
    <message>
        <source>Images and forces only.</source>
        <translation>Nur Bilder und Kräfte.</translation>
    </message>
    <message>
        <source>left stick</source>
        <translation>linker Stick</translation>
    </message>
    <message>
        <source>moves the needle; cross: lifts and lowers it</source>
        <translation>bewegt die Nadel; Steuerkreuz: hebt und senkt sie</translation>
    </message>
    <message>
        <source>right stick</source>
        <translation>rechter Stick</translation>
    </message>
    <message>
        <source>swings the tip in the direction of the stick</source>
        <translation>schwenkt die Spitze in Richtung des Sticks</translation>
    </message>
    <message>
        <source>triggers</source>
        <translation>Trigger</translation>
    </message>
    <message>
        <source>right: push in, left: pull out; rumble: resistance</source>
        <translation>rechts: vorschieben, links: zurückziehen; Vibration: Widerstand</translation>
    </message>
    <message>
        <source>shoulders</source>
        <translation>Schultertasten</translation>
    </message>
    <message>
        <source>turn the bevel</source>
        <translation>drehen den Schliff</translation>
    </message>
    <message>
        <source>moves the transducer; cross: lifts and lowers it</source>
        <translation>bewegt den Schallkopf; Steuerkreuz: hebt und senkt ihn</translation>
    </message>
    <message>
        <source>tilts it</source>
        <translation>kippt ihn</translation>
    </message>
    <message>
        <source>turn it</source>
        <translation>drehen ihn</translation>
    </message>
    <message>
        <source>Click the target: in a slice, or by a double click in 3D. Esc: done.</source>
        <translation>Klicken Sie das Ziel an: in einem Schnitt oder mit Doppelklick in 3D. Esc: fertig.</translation>
    </message>
    <message>
        <source>Click the centre of the entry zone on the skin. Esc: done.</source>
        <translation>Klicken Sie die Mitte der Einstichzone auf der Haut an. Esc: fertig.</translation>
    </message>
    <message>
        <source>Click the entry point; it is moved onto the skin. Esc: done.</source>
        <translation>Klicken Sie die Einstichstelle an; sie wird auf die Haut verschoben. Esc: fertig.</translation>
    </message>
    <message>
        <source>Click the end position of the tip. Esc: done.</source>
        <translation>Klicken Sie die Endposition der Spitze an. Esc: fertig.</translation>
    </message>
    <message>
        <source>Click the position of “%1”: in a slice, or double-click in 3D. Esc: done.</source>
        <translation>Klicken Sie die Position von „%1“ an: in einem Schnitt oder mit Doppelklick in 3D. Esc: fertig.</translation>
    </message>
    <message>
        <source>Click “%1” in a slice of the CT, and in one of the ultrasound. Esc: done.</source>
        <translation>Klicken Sie „%1“ in einem Schnitt des CT und in einem des Ultraschalls an. Esc: fertig.</translation>
    </message>
    <message>
        <source>Choose</source>
        <translation>Auswahl</translation>
    </message>
    <message>
        <source>Briefing</source>
        <translation>Einweisung</translation>
    </message>
    <message>
        <source>Puncture</source>
        <translation>Punktion</translation>
    </message>
    <message>
        <source>Feedback</source>
        <translation>Auswertung</translation>
    </message>
    <message>
        <source>in order</source>
        <translation>in Ordnung</translation>
    </message>
    <message>
        <source>doubtful</source>
        <translation>zweifelhaft</translation>
    </message>
    <message>
        <source>wrong</source>
        <translation>falsch</translation>
    </message>
    <message>
        <source>Axial</source>
        <translation>Axial</translation>
    </message>
    <message>
        <source>Coronal</source>
        <translation>Koronal</translation>
    </message>
    <message>
        <source>Sagittal</source>
        <translation>Sagittal</translation>
    </message>
    <message>
        <source>Along needle</source>
        <translation>Längs der Nadel</translation>
    </message>
    <message>
        <source>Along, turned</source>
        <translation>Längs, gedreht</translation>
    </message>
    <message>
        <source>Across needle</source>
        <translation>Quer zur Nadel</translation>
    </message>
    <message>
        <source>Ultrasound, lateral</source>
        <translation>Ultraschall, lateral</translation>
    </message>
    <message>
        <source>Ultrasound, elevation</source>
        <translation>Ultraschall, Elevation</translation>
    </message>
    <message>
        <source>Ultrasound, C-plane</source>
        <translation>Ultraschall, C-Ebene</translation>
    </message>
    <message>
        <source>Left drag: move the cross-hairs (arrow keys) · wheel: scroll (Page Up, Page Down) · Ctrl + wheel: zoom (+, −)
Right drag: window (1–5: presets) · middle or Shift + left drag: pan · double click: centre
R: reset · L: labels on and off</source>
        <translation>Links ziehen: Fadenkreuz bewegen (Pfeiltasten) · Rad: blättern (Bild auf, Bild ab) · Strg + Rad: zoomen (+, −)
Rechts ziehen: Fenster (1–5: Vorgaben) · Mitte oder Umschalt + links ziehen: verschieben · Doppelklick: zentrieren
R: zurücksetzen · L: Labels ein und aus</translation>
    </message>
    <message>
        <source>Left drag: move the cross-hairs (arrow keys) · wheel: scroll (Page Up, Page Down) · Ctrl + wheel: zoom (+, −)
Right drag: brightness and contrast · middle or Shift + left drag: pan · double click: centre · R: reset</source>
        <translation>Links ziehen: Fadenkreuz bewegen (Pfeiltasten) · Rad: blättern (Bild auf, Bild ab) · Strg + Rad: zoomen (+, −)
Rechts ziehen: Helligkeit und Kontrast · Mitte oder Umschalt + links ziehen: verschieben · Doppelklick: zentrieren · R: zurücksetzen</translation>
    </message>
    <message>
        <source>AP</source>
        <translation>AP</translation>
    </message>
    <message>
        <source>RAO 30</source>
        <translation>RAO 30</translation>
    </message>
    <message>
        <source>LAO 30</source>
        <translation>LAO 30</translation>
    </message>
    <message>
        <source>Lateral</source>
        <translation>Seitlich</translation>
    </message>
    <message>
        <source>Ultrasound</source>
        <translation>Ultraschall</translation>
    </message>
    <message>
        <source>Navigation</source>
        <translation>Navigation</translation>
    </message>
    <message>
        <source>Slices</source>
        <translation>Schnitte</translation>
    </message>
    <message>
        <source>X-ray</source>
        <translation>Röntgen</translation>
    </message>
</context>
<context>
    <name>TrainerChoiceText</name>
    <message>
        <source>The case is known: a patient folder has no unseen variant.</source>
        <translation>Der Fall ist bekannt: Ein Patientenordner hat keine unbekannte Variante.</translation>
    </message>
    <message>
        <source>Exam %1: this body is known from an earlier attempt.</source>
        <translation>Prüfung %1: Dieser Körper ist aus einem früheren Versuch bekannt.</translation>
    </message>
    <message>
        <source>Exam %1: an unseen body.</source>
        <translation>Prüfung %1: ein unbekannter Körper.</translation>
    </message>
    <message>
        <source>The result will name nobody: go back and choose who you are on the start page.</source>
        <translation>Das Ergebnis wird niemanden nennen: Gehen Sie zurück und wählen Sie auf der Startseite, wer Sie sind.</translation>
    </message>
</context>
<context>
    <name>UltrasoundPainter</name>
    <message>
        <source>Cine</source>
        <translation>Cine</translation>
    </message>
    <message>
        <source>Frozen</source>
        <translation>Eingefroren</translation>
    </message>
    <message>
        <source>No contact</source>
        <translation>Kein Kontakt</translation>
    </message>
    <message>
        <source>Poor contact</source>
        <translation>Schlechter Kontakt</translation>
    </message>
    <message>
        <source>Outside CT</source>
        <translation>Außerhalb des CT</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ActionButtons</name>
    <message>
        <source>Anaesthetic</source>
        <translation>Betäuben</translation>
    </message>
    <message>
        <source>Reinsert stylet</source>
        <translation>Mandrin rein</translation>
    </message>
    <message>
        <source>Remove stylet</source>
        <translation>Mandrin ziehen</translation>
    </message>
    <message>
        <source>Aspirate</source>
        <translation>Aspirieren</translation>
    </message>
    <message>
        <source>Wire further</source>
        <translation>Draht weiter</translation>
    </message>
    <message>
        <source>Guide wire</source>
        <translation>Führungsdraht</translation>
    </message>
    <message>
        <source>Breathe</source>
        <translation>Weiteratmen</translation>
    </message>
    <message>
        <source>Hold breath</source>
        <translation>Atem anhalten</translation>
    </message>
    <message>
        <source>Load the gun</source>
        <translation>Pistole spannen</translation>
    </message>
    <message>
        <source>Inject %1 ml of local anaesthetic</source>
        <translation>%1 ml Lokalanästhetikum injizieren</translation>
    </message>
    <message>
        <source>Reinsert the stylet</source>
        <translation>Mandrin wieder einführen</translation>
    </message>
    <message>
        <source>Remove the stylet and see what comes out of the needle</source>
        <translation>Mandrin ziehen und beobachten, was aus der Nadel austritt</translation>
    </message>
    <message>
        <source>Advance the guide wire by %1 mm</source>
        <translation>Führungsdraht um %1 mm vorschieben</translation>
    </message>
    <message>
        <source>Let the patient breathe again</source>
        <translation>Patienten weiteratmen lassen</translation>
    </message>
    <message>
        <source>Ask the patient to hold the breath</source>
        <translation>Patienten bitten, den Atem anzuhalten</translation>
    </message>
    <message>
        <source>The attempt is not running.</source>
        <translation>Der Versuch läuft nicht.</translation>
    </message>
    <message>
        <source>Remove the stylet first (%1).</source>
        <translation>Ziehen Sie zuerst den Mandrin (%1).</translation>
    </message>
    <message>
        <source>The gun is loaded.</source>
        <translation>Die Biopsiepistole ist gespannt.</translation>
    </message>
    <message>
        <source>Withdraw the needle first: without a coaxial needle the gun is loaded outside.</source>
        <translation>Ziehen Sie zuerst die Nadel heraus: Ohne Koaxialnadel wird die Biopsiepistole außerhalb des Körpers gespannt.</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::AttemptControl</name>
    <message>
        <source>A list or slider has the keyboard: click a view, then press the key again.</source>
        <translation>Die Tastatur wirkt gerade auf eine Liste oder einen Regler: Klicken Sie eine Ansicht an und drücken Sie die Taste erneut.</translation>
    </message>
    <message>
        <source>End the attempt and score it? It continues until you confirm.</source>
        <translation>Versuch beenden und bewerten? Er läuft weiter, bis Sie bestätigen.</translation>
    </message>
    <message>
        <source>End (Enter)</source>
        <translation>Beenden (Enter)</translation>
    </message>
    <message>
        <source>Close the trainer? This ends the attempt: it is scored as it is if the needle was in the body.</source>
        <translation>Programm schließen? Das beendet den Versuch: Er wird im jetzigen Stand bewertet, wenn die Nadel im Körper war.</translation>
    </message>
    <message>
        <source>Close (Enter)</source>
        <translation>Schließen (Enter)</translation>
    </message>
    <message>
        <source>The planned position is available in guided attempts only.</source>
        <translation>Die geplante Position gibt es nur in angeleiteten Versuchen.</translation>
    </message>
    <message>
        <source>Select needle (%1) or transducer (%2) first.</source>
        <translation>Wählen Sie zuerst Nadel (%1) oder Schallkopf (%2) aus.</translation>
    </message>
    <message>
        <source>Withdraw the needle first: it moves to the planned position outside the body only.</source>
        <translation>Ziehen Sie zuerst die Nadel heraus: Sie bewegt sich nur außerhalb des Körpers an die geplante Position.</translation>
    </message>
    <message>
        <source>The gun is empty: take the core out and load it (%1).</source>
        <translation>Die Biopsiepistole ist nicht gespannt: Entnehmen Sie den Stanzzylinder und spannen Sie sie (%1).</translation>
    </message>
    <message>
        <source>the gun was fired</source>
        <translation>die Biopsiepistole wurde ausgelöst</translation>
    </message>
    <message>
        <source>the patient feels pain</source>
        <translation>der Patient hat Schmerzen</translation>
    </message>
    <message>
        <source>shot</source>
        <translation>Auslösung</translation>
    </message>
    <message>
        <source>This needle has no lumen.</source>
        <translation>Diese Nadel hat kein Lumen.</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::BriefingPage</name>
    <message>
        <source>end of the path</source>
        <translation>Ende des Weges</translation>
    </message>
    <message>
        <source>target</source>
        <translation>Ziel</translation>
    </message>
    <message>
        <source>entry</source>
        <translation>Einstichstelle</translation>
    </message>
    <message>
        <source>planned path</source>
        <translation>geplanter Weg</translation>
    </message>
    <message>
        <source>Referral</source>
        <translation>Überweisung</translation>
    </message>
    <message>
        <source>Procedure</source>
        <translation>Eingriff</translation>
    </message>
    <message>
        <source>Scoring</source>
        <translation>Bewertung</translation>
    </message>
    <message>
        <source>Controls</source>
        <translation>Bedienung</translation>
    </message>
    <message>
        <source>Target location</source>
        <translation>Lage des Ziels</translation>
    </message>
    <message>
        <source>Back</source>
        <translation>Zurück</translation>
    </message>
    <message>
        <source>Begin</source>
        <translation>Beginnen</translation>
    </message>
    <message>
        <source>Briefing</source>
        <translation>Einweisung</translation>
    </message>
    <message>
        <source>Finding</source>
        <translation>Befund</translation>
    </message>
    <message>
        <source>follows when the images are loaded</source>
        <translation>folgt, sobald die Bilder geladen sind</translation>
    </message>
    <message>
        <source>The images are being loaded.</source>
        <translation>Die Bilder werden geladen.</translation>
    </message>
    <message>
        <source>Opening the patient</source>
        <translation>Patient wird geöffnet</translation>
    </message>
    <message>
        <source>Ready</source>
        <translation>Bereit</translation>
    </message>
    <message>
        <source>Ready. Being prepared: %1</source>
        <translation>Bereit. In Vorbereitung: %1</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::CaseLandmarkPairs</name>
    <message>
        <source>Name of the landmark pair</source>
        <translation>Name des Landmarkenpaars</translation>
    </message>
    <message>
        <source>A landmark of the case, or any other name: a branching of a vessel, the pole of a kidney</source>
        <translation>Eine Landmarke des Falls oder ein beliebiger anderer Name: eine Gefäßgabelung, ein Nierenpol</translation>
    </message>
    <message>
        <source>Place by click</source>
        <translation>Per Klick setzen</translation>
    </message>
    <message>
        <source>Click the same place in a slice of the CT and in one of the ultrasound, in any order</source>
        <translation>Dieselbe Stelle in einem Schnitt des CT und in einem des Ultraschalls anklicken, in beliebiger Reihenfolge</translation>
    </message>
    <message>
        <source>New</source>
        <translation>Neu</translation>
    </message>
    <message>
        <source>Begin another landmark: the next free number</source>
        <translation>Weitere Landmarke beginnen: die nächste freie Nummer</translation>
    </message>
    <message>
        <source>Landmark pairs</source>
        <translation>Landmarkenpaare</translation>
    </message>
    <message>
        <source>Click to go there  (Enter); Delete removes the landmark of the ultrasound</source>
        <translation>Klick: dorthin gehen  (Enter); Entf entfernt die Landmarke des Ultraschalls</translation>
    </message>
    <message>
        <source>Landmark</source>
        <translation>Landmarke</translation>
    </message>
    <message>
        <source>CT</source>
        <translation>CT</translation>
    </message>
    <message>
        <source>US</source>
        <translation>US</translation>
    </message>
    <message>
        <source>Off</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>Distance between both points after the fit</source>
        <translation>Abstand beider Punkte nach dem Einpassen</translation>
    </message>
    <message>
        <source>Fit landmarks</source>
        <translation>Einpassen</translation>
    </message>
    <message>
        <source>Place the ultrasound by its landmark pairs: 3 or more</source>
        <translation>Ultraschall anhand der Landmarkenpaare platzieren: 3 oder mehr</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Entfernen</translation>
    </message>
    <message>
        <source>Remove the landmark from the ultrasound  (Delete)</source>
        <translation>Landmarke aus dem Ultraschall entfernen  (Entf)</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
    <message>
        <source>%1 pairs fit within %2 mm (rms).</source>
        <translation>%1 Paare stimmen auf %2 mm überein (RMS).</translation>
    </message>
    <message>
        <source>%1 of at least 3 pairs.</source>
        <translation>%1 von mindestens 3 Paaren.</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::CaseLandmarks</name>
    <message>
        <source>Name: select one, or type a name</source>
        <translation>Name: auswählen oder eingeben</translation>
    </message>
    <message>
        <source>Name of the landmark</source>
        <translation>Name der Landmarke</translation>
    </message>
    <message>
        <source>One of the list, or any other name</source>
        <translation>Einer aus der Liste oder ein beliebiger anderer</translation>
    </message>
    <message>
        <source>Place by click</source>
        <translation>Per Klick setzen</translation>
    </message>
    <message>
        <source>Click in a slice, or double-click in 3D; click again to move it</source>
        <translation>In einen Schnitt klicken oder in 3D doppelklicken; ein weiterer Klick verschiebt die Landmarke</translation>
    </message>
    <message>
        <source>Landmarks</source>
        <translation>Landmarken</translation>
    </message>
    <message>
        <source>Click to go there  (Enter); F2 renames, Delete removes</source>
        <translation>Klick: dorthin gehen  (Enter); F2 benennt um, Entf entfernt</translation>
    </message>
    <message>
        <source>Rename</source>
        <translation>Umbenennen</translation>
    </message>
    <message>
        <source>Rename the selected landmark  (F2)</source>
        <translation>Ausgewählte Landmarke umbenennen  (F2)</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Entfernen</translation>
    </message>
    <message>
        <source>Remove the selected landmark  (Delete)</source>
        <translation>Ausgewählte Landmarke entfernen  (Entf)</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::CasePage</name>
    <message>
        <source>Case builder</source>
        <translation>Fall-Editor</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>Rückgängig</translation>
    </message>
    <message>
        <source>Redo</source>
        <translation>Wiederholen</translation>
    </message>
    <message>
        <source>Import</source>
        <translation>Import</translation>
    </message>
    <message>
        <source>Labels</source>
        <translation>Labels</translation>
    </message>
    <message>
        <source>Target</source>
        <translation>Ziel</translation>
    </message>
    <message>
        <source>Path</source>
        <translation>Weg</translation>
    </message>
    <message>
        <source>Forces</source>
        <translation>Kräfte</translation>
    </message>
    <message>
        <source>Ultrasound</source>
        <translation>Ultraschall</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>Speichern</translation>
    </message>
    <message>
        <source>Go to this step</source>
        <translation>Zu diesem Schritt gehen</translation>
    </message>
    <message>
        <source>Import CT and labels</source>
        <translation>CT und Labels importieren</translation>
    </message>
    <message>
        <source>Check the labels</source>
        <translation>Labels prüfen</translation>
    </message>
    <message>
        <source>Target and risks</source>
        <translation>Ziel und Risiken</translation>
    </message>
    <message>
        <source>Entry and path</source>
        <translation>Einstichstelle und Weg</translation>
    </message>
    <message>
        <source>Forces along the path</source>
        <translation>Kräfte entlang des Weges</translation>
    </message>
    <message>
        <source>Recorded ultrasound</source>
        <translation>Aufgezeichneter Ultraschall</translation>
    </message>
    <message>
        <source>Name and save</source>
        <translation>Benennen und speichern</translation>
    </message>
    <message>
        <source>Progress</source>
        <translation>Fortschritt</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Cancel the running work; the case is unchanged</source>
        <translation>Laufenden Vorgang abbrechen; der Fall bleibt unverändert</translation>
    </message>
    <message>
        <source>Undo: %1  (Ctrl+Z)</source>
        <translation>Rückgängig: %1  (Strg+Z)</translation>
    </message>
    <message>
        <source>Redo: %1  (Ctrl+Shift+Z)</source>
        <translation>Wiederholen: %1  (Strg+Umschalt+Z)</translation>
    </message>
    <message>
        <source>Unsaved case</source>
        <translation>Nicht gespeicherter Fall</translation>
    </message>
    <message>
        <source>Discard the case</source>
        <translation>Fall verwerfen</translation>
    </message>
    <message>
        <source>Go back to the case</source>
        <translation>Zurück zum Fall</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::CasePanel</name>
    <message>
        <source>usual</source>
        <translation>üblich</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::CheckList</name>
    <message>
        <source>Checks of the case</source>
        <translation>Prüfpunkte des Falls</translation>
    </message>
    <message>
        <source>Click to go to the problem  (Enter)</source>
        <translation>Klick: zum Problem gehen  (Enter)</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::CorePicture</name>
    <message>
        <source>target tissue</source>
        <translation>Zielgewebe</translation>
    </message>
    <message>
        <source>organ</source>
        <translation>Organ</translation>
    </message>
    <message>
        <source>vessel</source>
        <translation>Gefäß</translation>
    </message>
    <message>
        <source>other tissue</source>
        <translation>anderes Gewebe</translation>
    </message>
    <message>
        <source>%1 mm %2</source>
        <translation>%1 mm %2</translation>
    </message>
    <message>
        <source>No tissue in the notch</source>
        <translation>Kein Gewebe in der Kerbe</translation>
    </message>
    <message>
        <source>%1 cores</source>
        <translation>%1 Stanzzylinder</translation>
    </message>
    <message>
        <source>Core</source>
        <translation>Stanzzylinder</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::CurvePlot</name>
    <message numerus="yes">
        <source>Learning curve of %n attempt(s)</source>
        <translation>
            <numerusform>Lernkurve aus %n Versuch</numerusform>
            <numerusform>Lernkurve aus %n Versuchen</numerusform>
        </translation>
    </message>
</context>
<context>
    <name>trocar::trainer::DecimalField</name>
    <message>
        <source>%1 to %2, decimals: at most %3</source>
        <translation>%1 bis %2, höchstens %3 Nachkommastellen</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::DeviceCheck</name>
    <message>
        <source>The device test ended unexpectedly.</source>
        <translation>Der Gerätetest wurde unerwartet beendet.</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::DeviceChoice</name>
    <message>
        <source>Already used for the other tool</source>
        <translation>Bereits für das andere Instrument verwendet</translation>
    </message>
    <message>
        <source>Add a device by name …</source>
        <translation>Anderes Gerät …</translation>
    </message>
    <message>
        <source>An OpenHaptics device with the name assigned in the vendor&apos;s setup program</source>
        <translation>Ein OpenHaptics-Gerät mit dem Namen, den das Einrichtungsprogramm des Herstellers vergeben hat</translation>
    </message>
    <message>
        <source>Needle device</source>
        <translation>Nadelgerät</translation>
    </message>
    <message>
        <source>Transducer device</source>
        <translation>Schallkopfgerät</translation>
    </message>
    <message>
        <source>Test</source>
        <translation>Testen</translation>
    </message>
    <message>
        <source>Tests connection, motion and forces of the device</source>
        <translation>Testet Verbindung, Bewegung und Kräfte des Geräts</translation>
    </message>
    <message>
        <source>Test the device of: %1</source>
        <translation>Testen: %1</translation>
    </message>
    <message>
        <source>Add a device</source>
        <translation>Gerät hinzufügen</translation>
    </message>
    <message>
        <source>Name of the OpenHaptics device, as in its setup program:</source>
        <translation>Name des OpenHaptics-Geräts wie in seinem Einrichtungsprogramm:</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::DeviceTestDialog</name>
    <message>
        <source>Calibrate: first put the stylus into its inkwell (Omni, Touch), or hold the arm in its reset position as the vendor&apos;s manual shows it (Premium).</source>
        <translation>Kalibrieren: Stecken Sie zuerst den Stift in seine Halterung (Omni, Touch), oder halten Sie den Arm in der Nullstellung, die das Handbuch des Herstellers zeigt (Premium).</translation>
    </message>
    <message>
        <source>It calibrates automatically in its calibration pit; then press its force button.</source>
        <translation>Das Gerät kalibriert sich automatisch in seiner Kalibriermulde; drücken Sie danach die Krafttaste.</translation>
    </message>
    <message>
        <source>It calibrates automatically with the grip on its rest.</source>
        <translation>Das Gerät kalibriert sich automatisch, wenn der Griff in seiner Ablage liegt.</translation>
    </message>
    <message>
        <source>Looking for the device …</source>
        <translation>Gerät wird gesucht …</translation>
    </message>
    <message>
        <source>Calibrated. The device responds: %1.</source>
        <translation>Kalibriert. Das Gerät antwortet: %1.</translation>
    </message>
    <message>
        <source>The device responds: %1.</source>
        <translation>Das Gerät antwortet: %1.</translation>
    </message>
    <message>
        <source>The device no longer responds. Check that it is plugged in, then test again.</source>
        <translation>Das Gerät antwortet nicht mehr. Prüfen Sie, ob es angeschlossen ist, und testen Sie erneut.</translation>
    </message>
    <message>
        <source>The device does not respond. %1</source>
        <translation>Das Gerät antwortet nicht. %1</translation>
    </message>
    <message>
        <source>Waiting for its pose …</source>
        <translation>Warten auf die Lage des Geräts …</translation>
    </message>
    <message>
        <source>Motion detected: %1 mm so far.</source>
        <translation>Bewegung erkannt: bisher %1 mm.</translation>
    </message>
    <message>
        <source>Move the device: the picture must follow.</source>
        <translation>Bewegen Sie das Gerät: Das Bild muss folgen.</translation>
    </message>
    <message>
        <source>Right %1, away %2, up %3 mm. Buttons: %4. %5</source>
        <translation>Rechts %1, hinten %2, oben %3 mm. Tasten: %4. %5</translation>
    </message>
    <message>
        <source>none</source>
        <translation>keine</translation>
    </message>
    <message>
        <source>Force now: %1 N upwards</source>
        <translation>Kraft jetzt: %1 N nach oben</translation>
    </message>
    <message>
        <source>The safety gate stopped the force: %1. Request it again.</source>
        <translation>Die Sicherheitsstufe hat die Kraft abgeschaltet: %1. Fordern Sie sie erneut an.</translation>
    </message>
    <message>
        <source>%1 N were applied. Did you feel the force?</source>
        <translation>%1 N wurden ausgeübt. Haben Sie die Kraft gespürt?</translation>
    </message>
    <message>
        <source>The computer was too busy for a force that can be felt. Request it again.</source>
        <translation>Der Rechner war für eine fühlbare Kraft zu stark ausgelastet. Fordern Sie sie erneut an.</translation>
    </message>
    <message>
        <source>No force is applied before you request it.</source>
        <translation>Eine Kraft wirkt erst, wenn Sie sie anfordern.</translation>
    </message>
    <message>
        <source>It has no motors for forces; a gamepad uses rumble.</source>
        <translation>Das Gerät hat keine Motoren für Kräfte; ein Gamepad vibriert stattdessen.</translation>
    </message>
    <message>
        <source>Test: %1</source>
        <translation>Test: %1</translation>
    </message>
    <message>
        <source>Give a small force</source>
        <translation>Kleine Kraft anfordern</translation>
    </message>
    <message>
        <source>Upwards, for about a second; hold the device</source>
        <translation>Nach oben, etwa eine Sekunde lang; halten Sie das Gerät fest</translation>
    </message>
    <message>
        <source>Calibrate</source>
        <translation>Kalibrieren</translation>
    </message>
    <message>
        <source>When the device is in the required position</source>
        <translation>Wenn das Gerät in der verlangten Stellung ist</translation>
    </message>
    <message>
        <source>Test again</source>
        <translation>Erneut testen</translation>
    </message>
    <message>
        <source>Opens the device again</source>
        <translation>Öffnet das Gerät erneut</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>Schließen</translation>
    </message>
    <message>
        <source>Release the device</source>
        <translation>Gerät freigeben</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ExamChoice</name>
    <message>
        <source>Difficulty</source>
        <translation>Schwierigkeit</translation>
    </message>
    <message>
        <source>Difficulty of the exam</source>
        <translation>Schwierigkeit der Prüfung</translation>
    </message>
    <message>
        <source>Difficulty, 1 (easiest) to 5; – is not graded</source>
        <translation>Schwierigkeit, 1 (am leichtesten) bis 5; – ist nicht eingestuft</translation>
    </message>
    <message>
        <source>No.</source>
        <translation>Nr.</translation>
    </message>
    <message>
        <source>Number of the exam</source>
        <translation>Nummer der Prüfung</translation>
    </message>
    <message>
        <source>drawn</source>
        <translation>Zufall</translation>
    </message>
    <message>
        <source>The same number is the same body for everyone; 1 draws one that was not practised here</source>
        <translation>Dieselbe Nummer bedeutet für alle denselben Körper; 1 lost einen aus, an dem hier nicht geübt wurde</translation>
    </message>
    <message>
        <source>Needle and forces are those of the task.</source>
        <translation>Nadel und Kräfte gibt die Aufgabe vor.</translation>
    </message>
    <message>
        <source>A patient folder has no unseen variant: the result says that the case is known.</source>
        <translation>Ein Patientenordner hat keine unbekannte Variante: Das Ergebnis vermerkt, dass der Fall bekannt ist.</translation>
    </message>
    <message>
        <source>%1 of 5</source>
        <translation>%1 von 5</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ExpertPathList</name>
    <message>
        <source>Expert paths</source>
        <translation>Expertenwege</translation>
    </message>
    <message>
        <source>Distance of the tip&apos;s path from each, mm</source>
        <translation>Abstand des Weges der Spitze von jedem Expertenweg, mm</translation>
    </message>
    <message>
        <source>Show the other paths</source>
        <translation>Andere Wege anzeigen</translation>
    </message>
    <message>
        <source>Fréchet</source>
        <translation>Fréchet</translation>
    </message>
    <message>
        <source>Fréchet distance between the path of the tip and the expert path</source>
        <translation>Fréchet-Abstand zwischen dem Weg der Spitze und dem Expertenweg</translation>
    </message>
    <message>
        <source>Hausdorff</source>
        <translation>Hausdorff</translation>
    </message>
    <message>
        <source>The largest distance of a point of one from the other</source>
        <translation>Der größte Abstand eines Punkts des einen vom anderen</translation>
    </message>
    <message>
        <source>%1 (nearest)</source>
        <translation>%1 (nächster)</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::FeedbackPanel</name>
    <message>
        <source>Not scored: %1</source>
        <translation>Nicht bewertet: %1</translation>
    </message>
    <message>
        <source>Passed</source>
        <translation>Bestanden</translation>
    </message>
    <message>
        <source>Not passed</source>
        <translation>Nicht bestanden</translation>
    </message>
    <message>
        <source>A structure at risk was touched</source>
        <translation>Eine Risikostruktur wurde berührt</translation>
    </message>
    <message>
        <source>Target reached</source>
        <translation>Ziel erreicht</translation>
    </message>
    <message>
        <source>The target was missed</source>
        <translation>Das Ziel wurde verfehlt</translation>
    </message>
    <message>
        <source>Critical harm: %1</source>
        <translation>Kritischer Schaden: %1</translation>
    </message>
    <message>
        <source>Major harm: %1</source>
        <translation>Schwerer Schaden: %1</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
    <message>
        <source>Target tissue in the core: %1</source>
        <translation>Zielgewebe im Stanzzylinder: %1</translation>
    </message>
    <message>
        <source>Target tissue in the cores: %1</source>
        <translation>Zielgewebe in den Stanzzylindern: %1</translation>
    </message>
    <message>
        <source>Risk of bleeding: %1</source>
        <translation>Blutungsrisiko: %1</translation>
    </message>
    <message>
        <source>Pain events: %1</source>
        <translation>Schmerzereignisse: %1</translation>
    </message>
    <message>
        <source>Improvements</source>
        <translation>Verbesserungen</translation>
    </message>
    <message>
        <source>Next exercise</source>
        <translation>Nächste Übung</translation>
    </message>
    <message>
        <source>Score</source>
        <translation>Punktzahl</translation>
    </message>
    <message>
        <source>Worst moment</source>
        <translation>Kritischster Moment</translation>
    </message>
    <message>
        <source>Other case</source>
        <translation>Anderer Fall</translation>
    </message>
    <message>
        <source>Report</source>
        <translation>Bericht</translation>
    </message>
    <message>
        <source>%1</source>
        <translation>%1</translation>
    </message>
    <message>
        <source>%1 / %2</source>
        <translation>%1 / %2</translation>
    </message>
    <message>
        <source>Next exam</source>
        <translation>Nächste Prüfung</translation>
    </message>
    <message>
        <source>Try again</source>
        <translation>Noch einmal</translation>
    </message>
    <message>
        <source>Another exam, on a body that you have not seen</source>
        <translation>Weitere Prüfung an einem Körper, den Sie noch nicht kennen</translation>
    </message>
    <message>
        <source>Repeat the same case</source>
        <translation>Denselben Fall wiederholen</translation>
    </message>
    <message>
        <source>Notes on the recording:</source>
        <translation>Anmerkungen zur Aufzeichnung:</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::FirstStepsCard</name>
    <message>
        <source>New here? Your first puncture, in about three minutes</source>
        <translation>Neu hier? Ihre erste Punktion in etwa drei Minuten</translation>
    </message>
    <message>
        <source>Six steps on a block of tissue: move, touch, press, feel a layer, reach the target, withdraw.</source>
        <translation>Sechs Schritte an einem Gewebeblock: bewegen, berühren, drücken, eine Schicht fühlen, das Ziel erreichen, zurückziehen.</translation>
    </message>
    <message>
        <source>Skip</source>
        <translation>Überspringen</translation>
    </message>
    <message>
        <source>Do not offer it any more; First steps, below, starts it</source>
        <translation>Nicht mehr anbieten; „Erste Schritte“ weiter unten startet die Übung</translation>
    </message>
    <message>
        <source>Begin with it</source>
        <translation>Damit beginnen</translation>
    </message>
    <message>
        <source>Open the block of tissue</source>
        <translation>Gewebeblock öffnen</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ForceBar</name>
    <message>
        <source>Resistance</source>
        <translation>Widerstand</translation>
    </message>
    <message>
        <source>Lag</source>
        <translation>Nachlauf</translation>
    </message>
    <message>
        <source>Resistance and lag</source>
        <translation>Widerstand und Nachlauf</translation>
    </message>
    <message>
        <source>Resistance: present force of the tissue, relative to the device&apos;s maximum; the line holds the peak.
Lag: distance of the tool behind the hand.</source>
        <translation>Widerstand: momentane Kraft des Gewebes, bezogen auf die Höchstkraft des Geräts; der Strich hält den Spitzenwert.
Nachlauf: Abstand, um den das Instrument hinter der Hand zurückbleibt.</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ForcePanel</name>
    <message>
        <source>Punctured layers</source>
        <translation>Durchstochene Schichten</translation>
    </message>
    <message>
        <source>Position and force of each puncture; double-click to go there</source>
        <translation>Ort und Kraft jedes Durchstichs; Doppelklick: dorthin gehen</translation>
    </message>
    <message>
        <source>Gives way</source>
        <translation>Gibt nach</translation>
    </message>
    <message>
        <source>at mm</source>
        <translation>bei mm</translation>
    </message>
    <message>
        <source>N</source>
        <translation>N</translation>
    </message>
    <message>
        <source>Import a patient first.</source>
        <translation>Importieren Sie zuerst einen Patienten.</translation>
    </message>
    <message>
        <source>At 10 mm/s along the path; at most %1 N.</source>
        <translation>Bei 10 mm/s auf dem Weg; höchstens %1 N.</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ForcePlot</name>
    <message>
        <source>predicted</source>
        <translation>Vorhersage</translation>
    </message>
    <message>
        <source>expert</source>
        <translation>Experte</translation>
    </message>
    <message>
        <source>Resistance</source>
        <translation>Widerstand</translation>
    </message>
    <message>
        <source>Resistance of the tissue along the needle. T: switch between depth and time</source>
        <translation>Widerstand des Gewebes entlang der Nadel. T: zwischen Tiefe und Zeit wechseln</translation>
    </message>
    <message>
        <source>Axis: depth or time</source>
        <translation>Achse: Tiefe oder Zeit</translation>
    </message>
    <message>
        <source>Against depth or time (T)</source>
        <translation>Über Tiefe oder Zeit (T)</translation>
    </message>
    <message>
        <source>Depth is hidden in an exam</source>
        <translation>Die Tiefe ist in einer Prüfung verborgen</translation>
    </message>
    <message>
        <source>depth</source>
        <translation>Tiefe</translation>
    </message>
    <message>
        <source>time</source>
        <translation>Zeit</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ForcePreview</name>
    <message>
        <source>Force model</source>
        <translation>Kraftmodell</translation>
    </message>
    <message>
        <source>Force model of the prediction and of the hand  (Up, Down)</source>
        <translation>Kraftmodell der Vorhersage und der Hand  (Pfeil auf, Pfeil ab)</translation>
    </message>
    <message>
        <source>Insertion (layers)</source>
        <translation>Einstich (Schichten)</translation>
    </message>
    <message>
        <source>Proxy (CT and walls)</source>
        <translation>Proxy (CT und Wände)</translation>
    </message>
    <message>
        <source>Combined</source>
        <translation>Kombiniert</translation>
    </message>
    <message>
        <source>default</source>
        <translation>Vorgabe</translation>
    </message>
    <message>
        <source>as set</source>
        <translation>eingestellt</translation>
    </message>
    <message>
        <source>Predicted force along the planned path at 10 mm/s: dashed: default; solid: changed</source>
        <translation>Vorhergesagte Kraft entlang des geplanten Weges bei 10 mm/s; gestrichelt: Vorgabe; durchgezogen: geändert</translation>
    </message>
    <message>
        <source>Predicting …</source>
        <translation>Berechnung …</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::HintList</name>
    <message>
        <source>Nothing to improve.</source>
        <translation>Nichts zu verbessern.</translation>
    </message>
    <message>
        <source>%1 s ▸</source>
        <translation>%1 s ▸</translation>
    </message>
    <message>
        <source>Show this moment in the replay; H: the next one</source>
        <translation>Diesen Moment in der Wiedergabe zeigen; H: den nächsten</translation>
    </message>
    <message>
        <source>%1 At %2 seconds: show in the replay.</source>
        <translation>%1 Bei %2 Sekunden: in der Wiedergabe zeigen.</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::HistoryCard</name>
    <message>
        <source>Your history at this task</source>
        <translation>Ihr Verlauf bei dieser Aufgabe</translation>
    </message>
    <message>
        <source>Points: your attempts, filled where passed. Line: their moving mean. Dashed: mean of the others at the same attempt. Band: experts.</source>
        <translation>Punkte: Ihre Versuche, ausgefüllt, wenn bestanden. Linie: ihr gleitender Mittelwert. Gestrichelt: Mittelwert der anderen beim selben Versuch. Band: Experten.</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ImportPanel</name>
    <message>
        <source>CT, or a complete patient folder</source>
        <translation>CT oder vollständiger Patientenordner</translation>
    </message>
    <message>
        <source>CT</source>
        <translation>CT</translation>
    </message>
    <message>
        <source>Path of a CT: NIfTI, NRRD, MHA, a DICOM folder; or a patient folder</source>
        <translation>Pfad eines CT: NIfTI, NRRD, MHA, ein DICOM-Ordner; oder ein Patientenordner</translation>
    </message>
    <message>
        <source>Labels (several: separated by ;)</source>
        <translation>Labels (mehrere: durch ; getrennt)</translation>
    </message>
    <message>
        <source>Labels</source>
        <translation>Labels</translation>
    </message>
    <message>
        <source>Paths of label volumes, masks, .seg.nrrd, or folders of masks</source>
        <translation>Pfade von Label-Volumen, Masken, .seg.nrrd oder Maskenordnern</translation>
    </message>
    <message>
        <source>Names of label numbers</source>
        <translation>Namen der Label-Nummern</translation>
    </message>
    <message>
        <source>TotalSegmentator&apos;s numbers, or a TOML file with a [labels] table</source>
        <translation>Nummern von TotalSegmentator oder eine TOML-Datei mit einer Tabelle [labels]</translation>
    </message>
    <message>
        <source>Recent</source>
        <translation>Zuletzt</translation>
    </message>
    <message>
        <source>Recent imports</source>
        <translation>Letzte Importe</translation>
    </message>
    <message>
        <source>Double click or Enter fills the fields</source>
        <translation>Doppelklick oder Enter füllt die Felder</translation>
    </message>
    <message>
        <source>Not imported: see what was found, and repair or confirm it</source>
        <translation>Nicht importiert: Prüfen Sie den Befund und beheben oder bestätigen Sie ihn</translation>
    </message>
    <message>
        <source>  (Enter imports)</source>
        <translation>  (Enter importiert)</translation>
    </message>
    <message>
        <source>File…</source>
        <translation>Datei…</translation>
    </message>
    <message>
        <source>Choose a CT file</source>
        <translation>CT-Datei wählen</translation>
    </message>
    <message>
        <source>Folder…</source>
        <translation>Ordner…</translation>
    </message>
    <message>
        <source>Choose a DICOM series or a patient folder</source>
        <translation>DICOM-Serie oder Patientenordner wählen</translation>
    </message>
    <message>
        <source>Volumes (%1);;All files (*)</source>
        <translation>Volumendaten (%1);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>DICOM series or patient folder</source>
        <translation>DICOM-Serie oder Patientenordner</translation>
    </message>
    <message>
        <source>Files…</source>
        <translation>Dateien…</translation>
    </message>
    <message>
        <source>Add label files</source>
        <translation>Label-Dateien hinzufügen</translation>
    </message>
    <message>
        <source>Add a folder of masks</source>
        <translation>Maskenordner hinzufügen</translation>
    </message>
    <message>
        <source>Folder of masks</source>
        <translation>Maskenordner</translation>
    </message>
    <message>
        <source>Posture for the puncture</source>
        <translation>Lagerung für die Punktion</translation>
    </message>
    <message>
        <source>How the patient lies or sits: a finding tells if the CT was taken otherwise. A complete patient keeps its own.</source>
        <translation>Wie der Patient liegt oder sitzt: Ein Befund zeigt an, wenn das CT anders aufgenommen wurde. Ein vollständiger Patient behält seine Lagerung.</translation>
    </message>
    <message>
        <source>Labels of a sibling series</source>
        <translation>Labels einer Schwesterserie</translation>
    </message>
    <message>
        <source>Accept a DICOM SEG or RTSTRUCT of another series with the same frame of reference, such as another reconstruction of the scan</source>
        <translation>DICOM SEG oder RTSTRUCT einer anderen Serie mit demselben Bezugssystem zulassen, etwa einer anderen Rekonstruktion derselben Aufnahme</translation>
    </message>
    <message>
        <source>Import</source>
        <translation>Importieren</translation>
    </message>
    <message>
        <source>Read the files and build the patient</source>
        <translation>Dateien lesen und Patienten aufbauen</translation>
    </message>
    <message>
        <source>It is right: import as it is</source>
        <translation>Es stimmt: so importieren</translation>
    </message>
    <message>
        <source>The patient is really like that; the case keeps this confirmation</source>
        <translation>Der Patient ist wirklich so; der Fall behält diese Bestätigung</translation>
    </message>
    <message>
        <source>It is right: keep it</source>
        <translation>Es stimmt: so belassen</translation>
    </message>
    <message>
        <source>Mirror the labels and import</source>
        <translation>Labels spiegeln und importieren</translation>
    </message>
    <message>
        <source>Mirror CT and labels and import</source>
        <translation>CT und Labels spiegeln und importieren</translation>
    </message>
    <message>
        <source>Import with this posture</source>
        <translation>Mit dieser Lagerung importieren</translation>
    </message>
    <message>
        <source>Use those numbers and import</source>
        <translation>Mit diesen Nummern importieren</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::LabelsPanel</name>
    <message>
        <source>Check box: show the structure in 3D.</source>
        <translation>Kästchen: Struktur in 3D zeigen.</translation>
    </message>
    <message>
        <source>Overlay</source>
        <translation>Deckkraft</translation>
    </message>
    <message>
        <source>Opacity of the labels</source>
        <translation>Deckkraft der Labels</translation>
    </message>
    <message>
        <source>Opacity of the labels over the CT  (arrow keys)</source>
        <translation>Deckkraft der Labels über dem CT  (Pfeiltasten)</translation>
    </message>
    <message>
        <source>Labels</source>
        <translation>Labels</translation>
    </message>
    <message>
        <source>Select a row to edit it below; double-click to go to the label</source>
        <translation>Zeile auswählen, um sie unten zu bearbeiten; Doppelklick: zum Label gehen</translation>
    </message>
    <message>
        <source>Label</source>
        <translation>Label</translation>
    </message>
    <message>
        <source>Tissue</source>
        <translation>Gewebe</translation>
    </message>
    <message>
        <source>ml</source>
        <translation>ml</translation>
    </message>
    <message>
        <source>Name of the label</source>
        <translation>Name des Labels</translation>
    </message>
    <message>
        <source>New name for the selected label  (Enter)</source>
        <translation>Neuer Name für das ausgewählte Label  (Enter)</translation>
    </message>
    <message>
        <source>Colour…</source>
        <translation>Farbe…</translation>
    </message>
    <message>
        <source>New colour for the selected label</source>
        <translation>Neue Farbe für das ausgewählte Label</translation>
    </message>
    <message>
        <source>Tissue of the label</source>
        <translation>Gewebe des Labels</translation>
    </message>
    <message>
        <source>Mechanical tissue of the selected label</source>
        <translation>Mechanisches Gewebe des ausgewählten Labels</translation>
    </message>
    <message>
        <source>Colour of %1</source>
        <translation>Farbe von %1</translation>
    </message>
    <message>
        <source>Derived: made by the program, not in the segmentation</source>
        <translation>Abgeleitet: vom Programm erzeugt, nicht in der Segmentierung</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::LearningControl</name>
    <message>
        <source>The result of the exam is being signed …</source>
        <translation>Das Prüfungsergebnis wird signiert …</translation>
    </message>
    <message>
        <source>Drawing an unseen body: %1</source>
        <translation>Ein unbekannter Körper wird ausgelost: %1</translation>
    </message>
    <message>
        <source>The result of the exam is signed: %1</source>
        <translation>Das Prüfungsergebnis ist signiert: %1</translation>
    </message>
    <message>
        <source>The result of the exam is not signed: %1</source>
        <translation>Das Prüfungsergebnis ist nicht signiert: %1</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::MainWindow</name>
    <message>
        <source>Trocar</source>
        <translation>Trocar</translation>
    </message>
    <message>
        <source>Current step, from the start page to the feedback</source>
        <translation>Aktueller Schritt, von der Startseite bis zur Auswertung</translation>
    </message>
    <message>
        <source>Views</source>
        <translation>Ansichten</translation>
    </message>
    <message>
        <source>Layouts and visible views</source>
        <translation>Anordnungen und sichtbare Ansichten</translation>
    </message>
    <message>
        <source>Text size</source>
        <translation>Schriftgröße</translation>
    </message>
    <message>
        <source>Language</source>
        <translation>Sprache</translation>
    </message>
    <message>
        <source>Tissues</source>
        <translation>Gewebe</translation>
    </message>
    <message>
        <source>Case builder</source>
        <translation>Fall-Editor</translation>
    </message>
    <message>
        <source>Keys</source>
        <translation>Tasten</translation>
    </message>
    <message>
        <source>The Tissues panel is closed in an exam: it shows path, depths and forces, and changes the task.</source>
        <translation>Der Bereich „Gewebe“ ist in einer Prüfung geschlossen: Er zeigt Weg, Tiefen und Kräfte und verändert die Aufgabe.</translation>
    </message>
    <message>
        <source>Biopsy gun sound</source>
        <translation>Ton der Biopsiepistole</translation>
    </message>
    <message>
        <source>The language changes when you open the window next time.</source>
        <translation>Die Sprache wechselt, wenn Sie das Fenster das nächste Mal öffnen.</translation>
    </message>
    <message>
        <source>As the desktop</source>
        <translation>Wie der Desktop</translation>
    </message>
    <message>
        <source>%1 %</source>
        <translation>%1 %</translation>
    </message>
    <message>
        <source>Larger</source>
        <translation>Größer</translation>
    </message>
    <message>
        <source>Smaller</source>
        <translation>Kleiner</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::MirrorDialog</name>
    <message>
        <source>Mirror workstation</source>
        <translation>Spiegelarbeitsplatz</translation>
    </message>
    <message>
        <source>For a monitor viewed in a mirror, with the hands behind the mirror.</source>
        <translation>Für einen Monitor, den Sie in einem Spiegel betrachten, mit den Händen hinter dem Spiegel.</translation>
    </message>
    <message>
        <source>Off</source>
        <translation>Aus</translation>
    </message>
    <message>
        <source>Left and right</source>
        <translation>Links und rechts</translation>
    </message>
    <message>
        <source>Up and down</source>
        <translation>Oben und unten</translation>
    </message>
    <message>
        <source>Mirrors the whole window with its menus and dialogs; F8 switches mirroring on and off</source>
        <translation>Spiegelt das ganze Fenster mit seinen Menüs und Dialogen; F8 schaltet die Spiegelung ein und aus</translation>
    </message>
    <message>
        <source>Mirror the window</source>
        <translation>Fenster spiegeln</translation>
    </message>
    <message>
        <source>Camera fixed to the device: the tool is displayed at the position of the hand</source>
        <translation>Kamera fest am Gerät: Das Instrument erscheint an der Position der Hand</translation>
    </message>
    <message>
        <source>Position of the mirror image, relative to the centre of the device&apos;s workspace:</source>
        <translation>Position des Spiegelbilds, bezogen auf die Mitte des Arbeitsraums des Geräts:</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>To the right</source>
        <translation>Nach rechts</translation>
    </message>
    <message>
        <source>Position of the window&apos;s centre (to the right)</source>
        <translation>Position der Fenstermitte (nach rechts)</translation>
    </message>
    <message>
        <source>Away from you</source>
        <translation>Von Ihnen weg</translation>
    </message>
    <message>
        <source>Position of the window&apos;s centre (away from you)</source>
        <translation>Position der Fenstermitte (von Ihnen weg)</translation>
    </message>
    <message>
        <source>Up</source>
        <translation>Nach oben</translation>
    </message>
    <message>
        <source>Position of the window&apos;s centre (up)</source>
        <translation>Position der Fenstermitte (nach oben)</translation>
    </message>
    <message>
        <source>Tilt</source>
        <translation>Neigung</translation>
    </message>
    <message>
        <source>0°: upright before you; 90°: horizontal, viewed from above</source>
        <translation>0°: aufrecht vor Ihnen; 90°: waagerecht, von oben betrachtet</translation>
    </message>
    <message>
        <source>°</source>
        <translation>°</translation>
    </message>
    <message>
        <source>Width of the screen</source>
        <translation>Bildschirmbreite</translation>
    </message>
    <message>
        <source>Width of the screen&apos;s image in the mirror</source>
        <translation>Breite des Bildschirmbilds im Spiegel</translation>
    </message>
    <message>
        <source>From your eye</source>
        <translation>Abstand vom Auge</translation>
    </message>
    <message>
        <source>Distance from the eye to the image</source>
        <translation>Abstand vom Auge zum Bild</translation>
    </message>
    <message>
        <source>Close</source>
        <translation>Schließen</translation>
    </message>
    <message>
        <source>The settings are saved</source>
        <translation>Die Einstellungen sind gespeichert</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::MirrorStation</name>
    <message>
        <source>Window mirrored: %1 switches mirroring off</source>
        <translation>Fenster gespiegelt: %1 schaltet die Spiegelung aus</translation>
    </message>
    <message>
        <source>Switch window mirroring on or off  (%1)</source>
        <translation>Fensterspiegelung ein- oder ausschalten  (%1)</translation>
    </message>
    <message>
        <source>Mirror workstation …</source>
        <translation>Spiegelarbeitsplatz …</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::NextExerciseCard</name>
    <message>
        <source>Start it</source>
        <translation>Starten</translation>
    </message>
    <message>
        <source>Next exercise: %1</source>
        <translation>Nächste Übung: %1</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::PalpationTag</name>
    <message>
        <source>Hard</source>
        <translation>Hart</translation>
    </message>
    <message>
        <source>Soft</source>
        <translation>Weich</translation>
    </message>
    <message>
        <source>Firm</source>
        <translation>Derb</translation>
    </message>
    <message>
        <source>%1: bone %2 mm below the skin</source>
        <translation>%1: Knochen %2 mm unter der Haut</translation>
    </message>
    <message>
        <source>%1: no bone straight below</source>
        <translation>%1: kein Knochen direkt darunter</translation>
    </message>
    <message>
        <source>yields %1 mm to %2 N</source>
        <translation>gibt bei %2 N um %1 mm nach</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ParameterList</name>
    <message>
        <source>Unlabelled tissue, by HU</source>
        <translation>Gewebe ohne Label, nach HU</translation>
    </message>
    <message>
        <source>Along the planned path</source>
        <translation>Entlang des geplanten Weges</translation>
    </message>
    <message>
        <source>Other tissues</source>
        <translation>Andere Gewebe</translation>
    </message>
    <message>
        <source>Show the parameters of this tissue  (Space)</source>
        <translation>Parameter dieses Gewebes anzeigen  (Leertaste)</translation>
    </message>
    <message>
        <source>changed</source>
        <translation>geändert</translation>
    </message>
    <message>
        <source>× multiplies a complete curve over HU.</source>
        <translation>× multipliziert eine ganze Kurve über HU.</translation>
    </message>
    <message>
        <source>↺  Reset %1</source>
        <translation>↺  %1 zurücksetzen</translation>
    </message>
    <message>
        <source>Reset %1</source>
        <translation>%1 zurücksetzen</translation>
    </message>
    <message>
        <source>Reset all parameters of this tissue to their defaults</source>
        <translation>Alle Parameter dieses Gewebes auf die Vorgaben zurücksetzen</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ParameterPanel</name>
    <message>
        <source>Open a case to adjust its tissues.</source>
        <translation>Öffnen Sie einen Fall, um seine Gewebe einzustellen.</translation>
    </message>
    <message>
        <source>Tissue parameters</source>
        <translation>Gewebeparameter</translation>
    </message>
    <message>
        <source>Tissues</source>
        <translation>Gewebe</translation>
    </message>
    <message>
        <source>Reset all</source>
        <translation>Zurücksetzen</translation>
    </message>
    <message>
        <source>Reset all parameters to those of the case</source>
        <translation>Alle Parameter auf die des Falls zurücksetzen</translation>
    </message>
    <message>
        <source>“%1” was not applied: %2</source>
        <translation>„%1“ wurde nicht übernommen: %2</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ParameterProfiles</name>
    <message>
        <source>1 number</source>
        <translation>1 Wert</translation>
    </message>
    <message>
        <source>%1 numbers</source>
        <translation>%1 Werte</translation>
    </message>
    <message>
        <source>Profile</source>
        <translation>Profil</translation>
    </message>
    <message>
        <source>Save as …</source>
        <translation>Speichern …</translation>
    </message>
    <message>
        <source>Save the parameters and the force model under a name  (Space)</source>
        <translation>Parameter und Kraftmodell unter einem Namen speichern  (Leertaste)</translation>
    </message>
    <message>
        <source>Delete</source>
        <translation>Löschen</translation>
    </message>
    <message>
        <source>Delete the selected profile; the parameters do not change  (Space)</source>
        <translation>Ausgewähltes Profil löschen; die Parameter ändern sich nicht  (Leertaste)</translation>
    </message>
    <message>
        <source>Name of the profile</source>
        <translation>Name des Profils</translation>
    </message>
    <message>
        <source>Name of the profile  (Enter saves, Escape cancels)</source>
        <translation>Name des Profils  (Enter speichert, Esc bricht ab)</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Name</translation>
    </message>
    <message>
        <source>Confirm  (Space)</source>
        <translation>Bestätigen  (Leertaste)</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Cancel  (Escape)</source>
        <translation>Abbrechen  (Esc)</translation>
    </message>
    <message>
        <source> (and %1 more)</source>
        <translation> (und %1 weitere)</translation>
    </message>
    <message>
        <source>As in the case</source>
        <translation>Wie im Fall</translation>
    </message>
    <message>
        <source>Tissue profile: %1  (Up, Down)</source>
        <translation>Gewebeprofil: %1  (Pfeil auf, Pfeil ab)</translation>
    </message>
    <message>
        <source>●  changed since it was selected</source>
        <translation>●  seit der Auswahl geändert</translation>
    </message>
    <message>
        <source>changed</source>
        <translation>geändert</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>Speichern</translation>
    </message>
    <message>
        <source>Replace</source>
        <translation>Ersetzen</translation>
    </message>
    <message>
        <source>%1 “%2”?</source>
        <translation>%1: „%2“?</translation>
    </message>
    <message>
        <source>Profile “%1” is deleted; its values stay active.</source>
        <translation>Profil „%1“ ist gelöscht; seine Werte bleiben aktiv.</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ParameterRow</name>
    <message>
        <source>Reset %1</source>
        <translation>%1 zurücksetzen</translation>
    </message>
    <message>
        <source>Reset to the default, %1</source>
        <translation>Auf die Vorgabe %1 zurücksetzen</translation>
    </message>
    <message>
        <source>Default %1%2</source>
        <translation>Vorgabe %1%2</translation>
    </message>
    <message>
        <source>Source: %1</source>
        <translation>Quelle: %1</translation>
    </message>
    <message>
        <source>Plausible range: %1 to %2%3</source>
        <translation>Plausibler Bereich: %1 bis %2%3</translation>
    </message>
    <message>
        <source>Taken: %1</source>
        <translation>Zulässig: %1</translation>
    </message>
    <message>
        <source>Same parameter as that of %1</source>
        <translation>Derselbe Parameter wie bei %1</translation>
    </message>
    <message>
        <source>insertion</source>
        <translation>Einstich</translation>
    </message>
    <message>
        <source>proxy</source>
        <translation>Proxy</translation>
    </message>
    <message>
        <source>combined</source>
        <translation>kombiniert</translation>
    </message>
    <message>
        <source>Used by: %1</source>
        <translation>Verwendet von: %1</translation>
    </message>
    <message>
        <source>Press Enter to apply; arrow keys move the slider</source>
        <translation>Enter übernimmt den Wert; die Pfeiltasten bewegen den Regler</translation>
    </message>
    <message>
        <source>&quot;%1&quot; is not valid: %2</source>
        <translation>„%1“ ist nicht zulässig: %2</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::PathPanel</name>
    <message>
        <source>Entry zone</source>
        <translation>Einstichzone</translation>
    </message>
    <message>
        <source>Expert&apos;s path</source>
        <translation>Expertenweg</translation>
    </message>
    <message>
        <source>Entry points within %1 mm get full points.</source>
        <translation>Einstichstellen innerhalb von %1 mm erhalten die volle Punktzahl.</translation>
    </message>
    <message>
        <source>No zone: the entry point is compared with the expert&apos;s.</source>
        <translation>Keine Zone: Die Einstichstelle wird mit der des Expertenwegs verglichen.</translation>
    </message>
    <message>
        <source>%1 mm from the skin to the end position of the tip.</source>
        <translation>%1 mm von der Haut bis zur Endposition der Spitze.</translation>
    </message>
    <message>
        <source>No path: it is planned each time the case is opened.</source>
        <translation>Kein Weg: Er wird bei jedem Öffnen des Falls geplant.</translation>
    </message>
    <message>
        <source>Click the skin</source>
        <translation>Haut anklicken</translation>
    </message>
    <message>
        <source>Click the centre of the zone on the skin</source>
        <translation>Mitte der Zone auf der Haut anklicken</translation>
    </message>
    <message>
        <source>Radius of the entry zone</source>
        <translation>Radius der Einstichzone</translation>
    </message>
    <message>
        <source>Radius of the entry zone  (up and down keys)</source>
        <translation>Radius der Einstichzone  (Pfeil auf, Pfeil ab)</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>Remove entry zone</source>
        <translation>Einstichzone entfernen</translation>
    </message>
    <message>
        <source>The entry point is then compared with the expert&apos;s path only</source>
        <translation>Die Einstichstelle wird dann nur mit dem Expertenweg verglichen</translation>
    </message>
    <message>
        <source>Plan automatically</source>
        <translation>Automatisch planen</translation>
    </message>
    <message>
        <source>The shortest path from the entry zone to the target that keeps all margins</source>
        <translation>Kürzester Weg von der Einstichzone zum Ziel, der alle Abstände einhält</translation>
    </message>
    <message>
        <source>Set entry</source>
        <translation>Einstich setzen</translation>
    </message>
    <message>
        <source>Click the entry point; drag to move it</source>
        <translation>Einstichstelle anklicken; Ziehen verschiebt sie</translation>
    </message>
    <message>
        <source>Set tip</source>
        <translation>Spitze setzen</translation>
    </message>
    <message>
        <source>Click the end position of the tip; drag to move it</source>
        <translation>Endposition der Spitze anklicken; Ziehen verschiebt sie</translation>
    </message>
    <message>
        <source>Remove path</source>
        <translation>Weg entfernen</translation>
    </message>
    <message>
        <source>The path is then planned each time the case is opened</source>
        <translation>Der Weg wird dann bei jedem Öffnen des Falls geplant</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::PatientView</name>
    <message>
        <source>3D view of the patient</source>
        <translation>3D-Ansicht des Patienten</translation>
    </message>
    <message>
        <source>Drag: rotate · Shift+drag: pan · wheel: zoom · 1–6: views · T: follow the tip · L: along the needle · B: side view</source>
        <translation>Ziehen: drehen · Umschalt+Ziehen: verschieben · Mausrad: zoomen · 1–6: Ansichten · T: der Spitze folgen · L: entlang der Nadel · B: Seitenansicht</translation>
    </message>
    <message>
        <source>3D surfaces</source>
        <translation>3D-Oberflächen</translation>
    </message>
    <message>
        <source>Being prepared: %1</source>
        <translation>In Vorbereitung: %1</translation>
    </message>
    <message>
        <source>3D</source>
        <translation>3D</translation>
    </message>
    <message>
        <source>Side view</source>
        <translation>Seitenansicht</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::PersonBar</name>
    <message>
        <source>Trainee</source>
        <translation>Lernende Person</translation>
    </message>
    <message>
        <source>Attempts are recorded for this person, in the database of the station or the department</source>
        <translation>Versuche werden für diese Person aufgezeichnet, in der Datenbank des Arbeitsplatzes oder der Abteilung</translation>
    </message>
    <message>
        <source>New person …</source>
        <translation>Neue Person …</translation>
    </message>
    <message>
        <source>Enter the name of somebody who is not in the list</source>
        <translation>Namen einer Person eingeben, die nicht in der Liste steht</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Name</translation>
    </message>
    <message>
        <source>PIN</source>
        <translation>PIN</translation>
    </message>
    <message>
        <source>Sign in</source>
        <translation>Anmelden</translation>
    </message>
    <message>
        <source>Sign in as this person</source>
        <translation>Als diese Person anmelden</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Back to the list of people</source>
        <translation>Zurück zur Personenliste</translation>
    </message>
    <message>
        <source>Nobody: results are not recorded</source>
        <translation>Niemand: ohne Aufzeichnung</translation>
    </message>
    <message>
        <source>%1 (%2)</source>
        <translation>%1 (%2)</translation>
    </message>
    <message>
        <source>New person</source>
        <translation>Neue Person</translation>
    </message>
    <message>
        <source>PIN, 4 to 12 digits</source>
        <translation>PIN, 4 bis 12 Ziffern</translation>
    </message>
    <message>
        <source>PIN, or leave empty</source>
        <translation>PIN oder leer lassen</translation>
    </message>
    <message>
        <source>%1, choose a PIN</source>
        <translation>%1, wählen Sie eine PIN</translation>
    </message>
    <message>
        <source>PIN of %1</source>
        <translation>PIN von %1</translation>
    </message>
    <message>
        <source>4 to 12 digits</source>
        <translation>4 bis 12 Ziffern</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::PosePicture</name>
    <message>
        <source>from above</source>
        <translation>von oben</translation>
    </message>
    <message>
        <source>from the front</source>
        <translation>von vorn</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::PuncturePanel</name>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
    <message>
        <source>Fire the gun</source>
        <translation>Pistole auslösen</translation>
    </message>
    <message>
        <source>End the attempt</source>
        <translation>Versuch beenden</translation>
    </message>
    <message>
        <source>Needle</source>
        <translation>Nadel</translation>
    </message>
    <message>
        <source>Active tool: the mouse moves the needle</source>
        <translation>Aktives Instrument: Die Maus bewegt die Nadel</translation>
    </message>
    <message>
        <source>Transducer</source>
        <translation>Schallkopf</translation>
    </message>
    <message>
        <source>Active tool: the mouse moves the transducer</source>
        <translation>Aktives Instrument: Die Maus bewegt den Schallkopf</translation>
    </message>
    <message>
        <source>Finger</source>
        <translation>Finger</translation>
    </message>
    <message>
        <source>Active tool: a finger feels the skin under the pointer; a click marks the place</source>
        <translation>Aktives Instrument: Ein Finger tastet die Haut unter dem Mauszeiger ab; ein Klick markiert die Stelle</translation>
    </message>
    <message>
        <source>View</source>
        <translation>Ansicht</translation>
    </message>
    <message>
        <source>No active tool: the mouse rotates the view</source>
        <translation>Kein aktives Instrument: Die Maus dreht die Ansicht</translation>
    </message>
    <message>
        <source>Lock</source>
        <translation>Fixieren</translation>
    </message>
    <message>
        <source>Hold the active tool in place</source>
        <translation>Aktives Instrument festhalten</translation>
    </message>
    <message>
        <source>Move to planned position</source>
        <translation>An geplante Position bewegen</translation>
    </message>
    <message>
        <source>Go on (Esc)</source>
        <translation>Weiter (Esc)</translation>
    </message>
    <message>
        <source>Continue the attempt</source>
        <translation>Versuch fortsetzen</translation>
    </message>
    <message>
        <source>Time since the needle touched the skin</source>
        <translation>Zeit seit dem Hautkontakt der Nadel</translation>
    </message>
    <message>
        <source>Tissue at the tip</source>
        <translation>Gewebe</translation>
    </message>
    <message>
        <source>Depth</source>
        <translation>Tiefe</translation>
    </message>
    <message>
        <source>Target</source>
        <translation>Ziel</translation>
    </message>
    <message>
        <source>Distance of the tip from the target</source>
        <translation>Abstand der Spitze vom Ziel</translation>
    </message>
    <message>
        <source>%1 s</source>
        <translation>%1 s</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ReplayControl</name>
    <message>
        <source>set before the start: %1</source>
        <translation>vor dem Start eingestellt: %1</translation>
    </message>
    <message>
        <source>%1 interruptions, %2 s in total; the longest at %3 s: %4 s, %5</source>
        <translation>%1 Unterbrechungen, insgesamt %2 s; die längste nach %3 s: %4 s, %5</translation>
    </message>
    <message>
        <source>at %1 s, %2</source>
        <translation>nach %1 s: %2</translation>
    </message>
    <message>
        <source>Worst moment: %1, after %2 s</source>
        <translation>Kritischster Moment: %1, nach %2 s</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ResultsControl</name>
    <message>
        <source>Choose a PIN.</source>
        <translation>Wählen Sie eine PIN.</translation>
    </message>
    <message>
        <source>The results cannot be recorded or read now: %1 Sessions stay on this station and are recorded later.</source>
        <translation>Die Ergebnisse können zurzeit weder aufgezeichnet noch gelesen werden: %1 Die Sitzungen bleiben an diesem Arbeitsplatz; ihre Ergebnisse werden später aufgezeichnet.</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::SavePanel</name>
    <message>
        <source>Name</source>
        <translation>Name</translation>
    </message>
    <message>
        <source>Name shown to trainees in the list of cases</source>
        <translation>Name, den Lernende in der Liste der Fälle sehen</translation>
    </message>
    <message>
        <source>Description</source>
        <translation>Beschreibung</translation>
    </message>
    <message>
        <source>Description shown to trainees before they begin</source>
        <translation>Beschreibung, die Lernende vor dem Beginn sehen</translation>
    </message>
    <message>
        <source>Source of the data, one line each</source>
        <translation>Herkunft der Daten, je eine Zeile</translation>
    </message>
    <message>
        <source>Data set, licence, who made the labels</source>
        <translation>Datensatz, Lizenz, wer die Labels erstellt hat</translation>
    </message>
    <message>
        <source>  (Tab goes on)</source>
        <translation>  (Tab: weiter)</translation>
    </message>
    <message>
        <source>Folder to create</source>
        <translation>Neuer Ordner</translation>
    </message>
    <message>
        <source>Folder for the case  (Enter saves)</source>
        <translation>Ordner für den Fall  (Enter speichert)</translation>
    </message>
    <message>
        <source>Choose…</source>
        <translation>Wählen…</translation>
    </message>
    <message>
        <source>Select the parent folder of the case folder</source>
        <translation>Übergeordneten Ordner des Fallordners auswählen</translation>
    </message>
    <message>
        <source>Replace the existing case</source>
        <translation>Vorhandenen Fall ersetzen</translation>
    </message>
    <message>
        <source>Without this option, nothing is overwritten</source>
        <translation>Ohne diese Option wird nichts überschrieben</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>Speichern</translation>
    </message>
    <message>
        <source>Write the case completely or not at all</source>
        <translation>Fall vollständig schreiben oder gar nicht</translation>
    </message>
    <message>
        <source>Open this case</source>
        <translation>Diesen Fall öffnen</translation>
    </message>
    <message>
        <source>Start an attempt with the saved case</source>
        <translation>Versuch mit dem gespeicherten Fall beginnen</translation>
    </message>
    <message>
        <source>Parent folder of the case</source>
        <translation>Übergeordneter Ordner des Falls</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ScoreDial</name>
    <message>
        <source>Score %1 of 100</source>
        <translation>Punktzahl %1 von 100</translation>
    </message>
    <message>
        <source>of 100</source>
        <translation>von 100</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::ScriptPlayer</name>
    <message>
        <source>%1 line %2: %3</source>
        <translation>%1 Zeile %2: %3</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::SliceView</name>
    <message>
        <source>%1 slice</source>
        <translation>Schnitt: %1</translation>
    </message>
    <message>
        <source>No ultrasound</source>
        <translation>Kein Ultraschall</translation>
    </message>
    <message>
        <source>No patient</source>
        <translation>Kein Patient</translation>
    </message>
    <message>
        <source>at the skin</source>
        <translation>an der Haut</translation>
    </message>
    <message>
        <source>at the tip</source>
        <translation>an der Spitze</translation>
    </message>
    <message>
        <source>no labels</source>
        <translation>ohne Labels</translation>
    </message>
    <message>
        <source>Axial</source>
        <translation>Axial</translation>
    </message>
    <message>
        <source>Coronal</source>
        <translation>Koronal</translation>
    </message>
    <message>
        <source>Sagittal</source>
        <translation>Sagittal</translation>
    </message>
    <message>
        <source>Along the needle</source>
        <translation>Entlang der Nadel</translation>
    </message>
    <message>
        <source>Across the tip</source>
        <translation>Quer zur Spitze</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::StartPage</name>
    <message>
        <source>Select a task and a patient</source>
        <translation>Aufgabe und Patient</translation>
    </message>
    <message>
        <source>A trainer, not a medical device.</source>
        <translation>Ein Simulator, kein Medizinprodukt.</translation>
    </message>
    <message>
        <source>First steps</source>
        <translation>Erste Schritte</translation>
    </message>
    <message>
        <source>A guided first puncture on a block of tissue</source>
        <translation>Eine angeleitete erste Punktion an einem Gewebeblock</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>Starten</translation>
    </message>
    <message>
        <source>Task</source>
        <translation>Aufgabe</translation>
    </message>
    <message>
        <source>Target organ: %1</source>
        <translation>Zielorgan: %1</translation>
    </message>
    <message>
        <source>Patient</source>
        <translation>Patient</translation>
    </message>
    <message>
        <source>Open a patient folder …</source>
        <translation>Patientenordner öffnen …</translation>
    </message>
    <message>
        <source>Open a folder made by the case builder or by trocar patient build</source>
        <translation>Ordner öffnen, den der Fall-Editor oder „trocar patient build“ erstellt hat</translation>
    </message>
    <message>
        <source>Level of help and tools</source>
        <translation>Hilfestufe und Instrumente</translation>
    </message>
    <message>
        <source>Needle</source>
        <translation>Nadel</translation>
    </message>
    <message>
        <source>Forces</source>
        <translation>Kräfte</translation>
    </message>
    <message>
        <source>As defined by the task</source>
        <translation>Wie in der Aufgabe</translation>
    </message>
    <message>
        <source>Breathing</source>
        <translation>Atmung</translation>
    </message>
    <message>
        <source>None</source>
        <translation>Keine</translation>
    </message>
    <message>
        <source>Quiet</source>
        <translation>Ruhig</translation>
    </message>
    <message>
        <source>Deep</source>
        <translation>Tief</translation>
    </message>
    <message>
        <source>Insertion model</source>
        <translation>Einstichmodell</translation>
    </message>
    <message>
        <source>Volume proxy</source>
        <translation>Volumen-Proxy</translation>
    </message>
    <message>
        <source>Both combined</source>
        <translation>Beide kombiniert</translation>
    </message>
    <message>
        <source>Review recording</source>
        <translation>Aufzeichnung ansehen</translation>
    </message>
    <message>
        <source>Score and replay the recording</source>
        <translation>Aufzeichnung bewerten und wiedergeben</translation>
    </message>
    <message>
        <source>Not now</source>
        <translation>Nicht jetzt</translation>
    </message>
    <message>
        <source>Keep the recording, without offering it again</source>
        <translation>Aufzeichnung behalten, aber nicht mehr anbieten</translation>
    </message>
    <message>
        <source>No patient for this task yet: open a folder.</source>
        <translation>Noch kein Patient für diese Aufgabe: Öffnen Sie einen Ordner.</translation>
    </message>
    <message>
        <source>Patient folder</source>
        <translation>Patientenordner</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::StatusStrip</name>
    <message>
        <source>STOP FORCES</source>
        <translation>KRÄFTE STOPPEN</translation>
    </message>
    <message>
        <source>Switches all forces off at once; press again to switch them on (Space)</source>
        <translation>Schaltet alle Kräfte sofort ab; nochmaliges Drücken schaltet sie wieder ein (Leertaste)</translation>
    </message>
    <message>
        <source>RESUME FORCES</source>
        <translation>KRÄFTE FORTSETZEN</translation>
    </message>
    <message>
        <source>State of forces and display: %1</source>
        <translation>Zustand von Kräften und Anzeige: %1</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::StepList</name>
    <message>
        <source>Show all steps, or only the current ones</source>
        <translation>Alle Schritte zeigen oder nur die aktuellen</translation>
    </message>
    <message>
        <source>done: %1</source>
        <translation>erledigt: %1</translation>
    </message>
    <message>
        <source>now: %1</source>
        <translation>jetzt: %1</translation>
    </message>
    <message>
        <source>Repeat this step: %1</source>
        <translation>Diesen Schritt wiederholen: %1</translation>
    </message>
    <message>
        <source>Repeat: %1</source>
        <translation>Wiederholen: %1</translation>
    </message>
    <message>
        <source>✓ Step %1 done</source>
        <translation>✓ Schritt %1 erledigt</translation>
    </message>
    <message>
        <source>All steps done</source>
        <translation>Alle Schritte erledigt</translation>
    </message>
    <message>
        <source>%1 of %2 steps done</source>
        <translation>%1 von %2 erledigt</translation>
    </message>
    <message>
        <source>All steps</source>
        <translation>Alle</translation>
    </message>
    <message>
        <source>Fewer</source>
        <translation>Weniger</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::StructurePanel</name>
    <message>
        <source>All</source>
        <translation>Alle</translation>
    </message>
    <message>
        <source>Default visibility of all structures</source>
        <translation>Vorgegebene Sichtbarkeit aller Strukturen</translation>
    </message>
    <message>
        <source>Skin</source>
        <translation>Haut</translation>
    </message>
    <message>
        <source>Skin only</source>
        <translation>Nur die Haut</translation>
    </message>
    <message>
        <source>Bones</source>
        <translation>Knochen</translation>
    </message>
    <message>
        <source>Bones and cartilage</source>
        <translation>Knochen und Knorpel</translation>
    </message>
    <message>
        <source>Vessels</source>
        <translation>Gefäße</translation>
    </message>
    <message>
        <source>Vessels and target, bones translucent</source>
        <translation>Gefäße und Ziel, Knochen durchscheinend</translation>
    </message>
    <message>
        <source>Target</source>
        <translation>Ziel</translation>
    </message>
    <message>
        <source>The target and the organ around it</source>
        <translation>Das Ziel und das umgebende Organ</translation>
    </message>
    <message>
        <source>Show or hide %1 (Space)</source>
        <translation>%1 ein- oder ausblenden (Leertaste)</translation>
    </message>
    <message>
        <source>Show %1</source>
        <translation>%1 einblenden</translation>
    </message>
    <message>
        <source>%1 (derived)</source>
        <translation>%1 (abgeleitet)</translation>
    </message>
    <message>
        <source>%1: made by the program, not in the segmentation</source>
        <translation>%1: vom Programm erzeugt, nicht in der Segmentierung</translation>
    </message>
    <message>
        <source>Opacity of %1 (arrow keys)</source>
        <translation>Deckkraft von %1 (Pfeiltasten)</translation>
    </message>
    <message>
        <source>Opacity of %1</source>
        <translation>Deckkraft von %1</translation>
    </message>
    <message>
        <source>CT volume rendering (Up, Down)</source>
        <translation>Volumendarstellung des CT (Pfeil auf, Pfeil ab)</translation>
    </message>
    <message>
        <source>CT volume</source>
        <translation>CT-Volumen</translation>
    </message>
    <message>
        <source>Surfaces</source>
        <translation>Oberflächen</translation>
    </message>
    <message>
        <source>CT: bone</source>
        <translation>CT: Knochen</translation>
    </message>
    <message>
        <source>CT: soft tissue</source>
        <translation>CT: Weichteile</translation>
    </message>
    <message>
        <source>CT: vessels</source>
        <translation>CT: Gefäße</translation>
    </message>
    <message>
        <source>CT: skin and bone</source>
        <translation>CT: Haut und Knochen</translation>
    </message>
    <message>
        <source>CT planes</source>
        <translation>CT-Ebenen</translation>
    </message>
    <message>
        <source>Along</source>
        <translation>Längs</translation>
    </message>
    <message>
        <source>CT plane along the needle</source>
        <translation>CT-Ebene entlang der Nadel</translation>
    </message>
    <message>
        <source>Turned</source>
        <translation>Gedreht</translation>
    </message>
    <message>
        <source>CT plane along the needle, turned by 90°</source>
        <translation>CT-Ebene entlang der Nadel, um 90° gedreht</translation>
    </message>
    <message>
        <source>Across</source>
        <translation>Quer</translation>
    </message>
    <message>
        <source>CT plane across the needle at its tip</source>
        <translation>CT-Ebene quer zur Nadel an ihrer Spitze</translation>
    </message>
    <message>
        <source>Guidance</source>
        <translation>Zielführung</translation>
    </message>
    <message>
        <source>Path, entry zone and target, as permitted by the level of help (O)</source>
        <translation>Weg, Einstichzone und Ziel, soweit die Hilfestufe sie zulässt (O)</translation>
    </message>
    <message>
        <source>Landmarks</source>
        <translation>Landmarken</translation>
    </message>
    <message>
        <source>Landmarks with names (I)</source>
        <translation>Landmarken mit Namen (I)</translation>
    </message>
    <message>
        <source>Camera ▾</source>
        <translation>Kamera ▾</translation>
    </message>
    <message>
        <source>Camera position</source>
        <translation>Kameraposition</translation>
    </message>
    <message>
        <source>Stereo ▾</source>
        <translation>Stereo ▾</translation>
    </message>
    <message>
        <source>Stereo and mirror modes</source>
        <translation>Stereo- und Spiegelmodi</translation>
    </message>
    <message>
        <source>Anterior	1</source>
        <translation>Von vorn	1</translation>
    </message>
    <message>
        <source>Right oblique	2</source>
        <translation>Rechts schräg	2</translation>
    </message>
    <message>
        <source>Right	3</source>
        <translation>Von rechts	3</translation>
    </message>
    <message>
        <source>Left	4</source>
        <translation>Von links	4</translation>
    </message>
    <message>
        <source>Posterior	5</source>
        <translation>Von hinten	5</translation>
    </message>
    <message>
        <source>Cranial	6</source>
        <translation>Vom Kopf her	6</translation>
    </message>
    <message>
        <source>Stay	Home</source>
        <translation>Feststehend	Pos1</translation>
    </message>
    <message>
        <source>Follow the tip	T</source>
        <translation>Der Spitze folgen	T</translation>
    </message>
    <message>
        <source>Look along the needle	L</source>
        <translation>Entlang der Nadel blicken	L</translation>
    </message>
    <message>
        <source>Side view at the tip	B</source>
        <translation>Seitenansicht der Spitze	B</translation>
    </message>
    <message>
        <source>Mono</source>
        <translation>Mono</translation>
    </message>
    <message>
        <source>Red-cyan glasses</source>
        <translation>Rot-Cyan-Brille</translation>
    </message>
    <message>
        <source>Side by side</source>
        <translation>Nebeneinander</translation>
    </message>
    <message>
        <source>Interlaced rows</source>
        <translation>Zeilenweise</translation>
    </message>
    <message>
        <source>Shutter glasses</source>
        <translation>Shutterbrille</translation>
    </message>
    <message>
        <source>Swap eyes</source>
        <translation>Augen tauschen</translation>
    </message>
    <message>
        <source>Mirror left-right</source>
        <translation>Links-rechts spiegeln</translation>
    </message>
    <message>
        <source>Mirror up-down</source>
        <translation>Oben-unten spiegeln</translation>
    </message>
    <message>
        <source> (Up, Down)</source>
        <translation> (Pfeil auf, Pfeil ab)</translation>
    </message>
    <message>
        <source>Eye angle, degrees</source>
        <translation>Stereowinkel, Grad</translation>
    </message>
    <message>
        <source>Focus shift</source>
        <translation>Fokusversatz</translation>
    </message>
    <message>
        <source>Structures</source>
        <translation>Strukturen</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::TargetPanel</name>
    <message>
        <source>Structures at risk</source>
        <translation>Risikostrukturen</translation>
    </message>
    <message>
        <source>Landmarks</source>
        <translation>Landmarken</translation>
    </message>
    <message>
        <source>no target yet</source>
        <translation>noch kein Ziel</translation>
    </message>
    <message>
        <source>point %1</source>
        <translation>Punkt %1</translation>
    </message>
    <message>
        <source>centre of the label, %1</source>
        <translation>Mitte des Labels, %1</translation>
    </message>
    <message>
        <source>Task, as a template</source>
        <translation>Aufgabe als Vorlage</translation>
    </message>
    <message>
        <source>Limits, scoring and risks are copied from this task</source>
        <translation>Grenzwerte, Bewertung und Risiken werden aus dieser Aufgabe übernommen</translation>
    </message>
    <message>
        <source>Target</source>
        <translation>Ziel</translation>
    </message>
    <message>
        <source>The target structure</source>
        <translation>Die Zielstruktur</translation>
    </message>
    <message>
        <source>Click a point</source>
        <translation>Punkt anklicken</translation>
    </message>
    <message>
        <source>Risk structures</source>
        <translation>Risikostrukturen</translation>
    </message>
    <message>
        <source>Select a row to change it below</source>
        <translation>Zeile auswählen, um sie unten zu ändern</translation>
    </message>
    <message>
        <source>Structure</source>
        <translation>Struktur</translation>
    </message>
    <message>
        <source>Margin</source>
        <translation>Abstand</translation>
    </message>
    <message>
        <source>Harm</source>
        <translation>Schaden</translation>
    </message>
    <message>
        <source>  (up and down keys)</source>
        <translation>  (Pfeil auf, Pfeil ab)</translation>
    </message>
    <message>
        <source>Required margin of a path</source>
        <translation>Geforderter Abstand eines Weges</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>What it means if the needle goes into it</source>
        <translation>Was es bedeutet, wenn die Nadel hineingerät</translation>
    </message>
    <message>
        <source>Structure to add</source>
        <translation>Neue Struktur</translation>
    </message>
    <message>
        <source>A tissue, or one label of this patient</source>
        <translation>Ein Gewebe oder ein Label dieses Patienten</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Ergänzen</translation>
    </message>
    <message>
        <source>Add this structure to the list</source>
        <translation>Diese Struktur zur Liste hinzufügen</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Entfernen</translation>
    </message>
    <message>
        <source>Remove the selected row from the list</source>
        <translation>Ausgewählte Zeile aus der Liste entfernen</translation>
    </message>
    <message>
        <source>as in the task</source>
        <translation>wie in der Aufgabe</translation>
    </message>
    <message>
        <source>all %1</source>
        <translation>Gewebe: %1</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::TimeLine</name>
    <message>
        <source>Replay</source>
        <translation>Wiedergabe</translation>
    </message>
    <message>
        <source>Play and pause (Space)</source>
        <translation>Wiedergabe starten oder anhalten (Leertaste)</translation>
    </message>
    <message>
        <source>Previous event (P)</source>
        <translation>Vorheriges Ereignis (P)</translation>
    </message>
    <message>
        <source>Next event (N)</source>
        <translation>Nächstes Ereignis (N)</translation>
    </message>
    <message>
        <source>Worst</source>
        <translation>Kritisch</translation>
    </message>
    <message>
        <source>Go to the worst moment (W)</source>
        <translation>Zum kritischsten Moment gehen (W)</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Tempo</translation>
    </message>
    <message>
        <source>Replay speed (&lt; slower, &gt; faster)</source>
        <translation>Wiedergabetempo (&lt; langsamer, &gt; schneller)</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::TimeTrack</name>
    <message>
        <source>Time</source>
        <translation>Zeit</translation>
    </message>
    <message>
        <source>Click or drag to go to a time (Left, Right, Home, End)</source>
        <translation>Klicken oder ziehen, um zu einem Zeitpunkt zu gehen (Pfeil links, Pfeil rechts, Pos1, Ende)</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::TrainerFlow</name>
    <message>
        <source>Needle</source>
        <translation>Nadel</translation>
    </message>
    <message>
        <source>Transducer</source>
        <translation>Schallkopf</translation>
    </message>
    <message>
        <source> Press Begin to try again, or Back for the start page.</source>
        <translation> Mit „Beginnen“ versuchen Sie es erneut, mit „Zurück“ kommen Sie zur Startseite.</translation>
    </message>
    <message>
        <source>The attempt is being scored. The case builder is available afterwards.</source>
        <translation>Der Versuch wird bewertet. Danach steht der Fall-Editor zur Verfügung.</translation>
    </message>
    <message>
        <source>The case builder is not available during an attempt. End the attempt first (E).</source>
        <translation>Während eines Versuchs steht der Fall-Editor nicht zur Verfügung. Beenden Sie zuerst den Versuch (E).</translation>
    </message>
    <message>
        <source>The last attempt was interrupted. Its recording is kept: you can score and replay it.</source>
        <translation>Der letzte Versuch wurde unterbrochen. Seine Aufzeichnung ist erhalten: Sie können sie bewerten lassen und wiedergeben.</translation>
    </message>
    <message>
        <source>The attempt has been opened in another trainer.</source>
        <translation>Der Versuch wurde in einem anderen Programmfenster geöffnet.</translation>
    </message>
    <message>
        <source>Report of the attempt</source>
        <translation>Bericht des Versuchs</translation>
    </message>
    <message>
        <source>Pages (*.html)</source>
        <translation>Seiten (*.html)</translation>
    </message>
    <message>
        <source>The report is in %1</source>
        <translation>Der Bericht liegt in %1</translation>
    </message>
    <message>
        <source>Close the trainer? The case in the case builder is not saved and would be lost.</source>
        <translation>Programm schließen? Der Fall im Fall-Editor ist nicht gespeichert und ginge verloren.</translation>
    </message>
    <message>
        <source>Finish signing in first: enter the PIN, or press Cancel beside it.</source>
        <translation>Schließen Sie zuerst die Anmeldung ab: Geben Sie die PIN ein oder drücken Sie daneben „Abbrechen“.</translation>
    </message>
    <message>
        <source>Reading the recording</source>
        <translation>Aufzeichnung wird gelesen</translation>
    </message>
    <message>
        <source>The recording of the interrupted attempt is being read.</source>
        <translation>Die Aufzeichnung des unterbrochenen Versuchs wird gelesen.</translation>
    </message>
    <message>
        <source>Attempts cannot be recorded now.</source>
        <translation>Versuche können zurzeit nicht aufgezeichnet werden.</translation>
    </message>
    <message>
        <source>Cannot record attempts in %1: %2</source>
        <translation>Versuche können nicht in %1 aufgezeichnet werden: %2</translation>
    </message>
    <message>
        <source>start trocar-trainer with --state and a folder with write permission</source>
        <translation>Starten Sie trocar-trainer mit --state und einem Ordner mit Schreibrecht</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::UltrasoundControls</name>
    <message>
        <source>Reset image settings</source>
        <translation>Bild zurücksetzen</translation>
    </message>
    <message>
        <source>Reset all image settings to the transducer&apos;s defaults</source>
        <translation>Alle Bildeinstellungen auf die Vorgaben des Schallkopfs zurücksetzen</translation>
    </message>
    <message>
        <source>Transducer</source>
        <translation>Schallkopf</translation>
    </message>
    <message>
        <source>Ultrasound array</source>
        <translation>Bauart des Schallkopfs</translation>
    </message>
    <message>
        <source>Preset</source>
        <translation>Untersuchung</translation>
    </message>
    <message>
        <source>Transducer and image settings for an examination</source>
        <translation>Schallkopf und Bildeinstellungen für eine Untersuchung</translation>
    </message>
    <message>
        <source>choose</source>
        <translation>wählen</translation>
    </message>
    <message>
        <source>Engine</source>
        <translation>Verfahren</translation>
    </message>
    <message>
        <source>Ray cast: from CT and labels; panorama: from the patient&apos;s stitched ultrasound volumes</source>
        <translation>Simulation: aus CT und Labels; Panorama: aus den zusammengesetzten Ultraschallvolumen des Patienten</translation>
    </message>
    <message>
        <source>Ray cast</source>
        <translation>Simulation</translation>
    </message>
    <message>
        <source>Panorama</source>
        <translation>Panorama</translation>
    </message>
    <message>
        <source>Freeze</source>
        <translation>Einfrieren</translation>
    </message>
    <message>
        <source>Previous frame  (%1)</source>
        <translation>Vorheriges Bild  (%1)</translation>
    </message>
    <message>
        <source>Next frame  (%1)</source>
        <translation>Nächstes Bild  (%1)</translation>
    </message>
    <message>
        <source>Play</source>
        <translation>Abspielen</translation>
    </message>
    <message>
        <source>Cine loop</source>
        <translation>Cine-Loop</translation>
    </message>
    <message>
        <source>Frames of the cine loop, oldest on the left</source>
        <translation>Bilder des Cine-Loops, das älteste links</translation>
    </message>
    <message>
        <source>Picture</source>
        <translation>Bild</translation>
    </message>
    <message>
        <source>Gain</source>
        <translation>Verstärkung</translation>
    </message>
    <message>
        <source>Gain of all echoes  (%1, %2)</source>
        <translation>Verstärkung aller Echos  (%1, %2)</translation>
    </message>
    <message>
        <source>Depth</source>
        <translation>Tiefe</translation>
    </message>
    <message>
        <source>Imaging depth  (%1, %2)</source>
        <translation>Bildtiefe  (%1, %2)</translation>
    </message>
    <message>
        <source>Frequency</source>
        <translation>Frequenz</translation>
    </message>
    <message>
        <source>Higher: better resolution; lower: more penetration</source>
        <translation>Höher: bessere Auflösung; niedriger: größere Eindringtiefe</translation>
    </message>
    <message>
        <source>Focus</source>
        <translation>Fokus</translation>
    </message>
    <message>
        <source>Depth of the transmit focus</source>
        <translation>Tiefe des Sendefokus</translation>
    </message>
    <message>
        <source>Dynamic range</source>
        <translation>Dynamik</translation>
    </message>
    <message>
        <source>Smaller: higher contrast</source>
        <translation>Kleiner: höherer Kontrast</translation>
    </message>
    <message>
        <source>Persistence</source>
        <translation>Persistenz</translation>
    </message>
    <message>
        <source>Weight of the previous frame</source>
        <translation>Gewicht des vorherigen Bildes</translation>
    </message>
    <message>
        <source>Automatic gain</source>
        <translation>Auto-Verstärkung</translation>
    </message>
    <message>
        <source>Gray map</source>
        <translation>Graukurve</translation>
    </message>
    <message>
        <source>Smaller  (%1)</source>
        <translation>Kleiner  (%1)</translation>
    </message>
    <message>
        <source>Larger  (%1); the middle button moves the image</source>
        <translation>Größer  (%1); die mittlere Maustaste verschiebt das Bild</translation>
    </message>
    <message>
        <source>Whole</source>
        <translation>Ganz</translation>
    </message>
    <message>
        <source>Zoom</source>
        <translation>Zoom</translation>
    </message>
    <message>
        <source>Harmonic imaging (THI)</source>
        <translation>Harmonische Bildgebung (THI)</translation>
    </message>
    <message>
        <source>Receives the second harmonic: less haze and fewer side lobes, less penetration</source>
        <translation>Empfängt die zweite Harmonische: weniger Schleier und Nebenkeulen, geringere Eindringtiefe</translation>
    </message>
    <message>
        <source>Marker on the left</source>
        <translation>Markierung links</translation>
    </message>
    <message>
        <source>Off: the image is mirrored; the green dot moves to the other side</source>
        <translation>Aus: Das Bild ist gespiegelt; der grüne Punkt wechselt auf die andere Seite</translation>
    </message>
    <message>
        <source>Rolling frame update</source>
        <translation>Gleitender Bildaufbau</translation>
    </message>
    <message>
        <source>While you move, each image renews a quarter of the scanlines, as in a scanner; off: whole frames</source>
        <translation>Während der Bewegung erneuert jedes Bild ein Viertel der Bildlinien, wie bei einem Ultraschallgerät; aus: ganze Bilder</translation>
    </message>
    <message>
        <source>Gain over depth (TGC)</source>
        <translation>Tiefenausgleich (TGC)</translation>
    </message>
    <message>
        <source>near</source>
        <translation>nah</translation>
    </message>
    <message>
        <source>far</source>
        <translation>fern</translation>
    </message>
    <message>
        <source>TGC slider %1 of 8, from near to far</source>
        <translation>TGC-Regler %1 von 8, von nah nach fern</translation>
    </message>
    <message>
        <source>Measure</source>
        <translation>Messen</translation>
    </message>
    <message>
        <source>Distance</source>
        <translation>Abstand</translation>
    </message>
    <message>
        <source>Click two points, or drag  (M)</source>
        <translation>Zwei Punkte anklicken oder ziehen  (M)</translation>
    </message>
    <message>
        <source>Ellipse</source>
        <translation>Ellipse</translation>
    </message>
    <message>
        <source>Ends of one axis, then the width</source>
        <translation>Enden einer Achse, dann die Breite</translation>
    </message>
    <message>
        <source>Angle</source>
        <translation>Winkel</translation>
    </message>
    <message>
        <source>Vertex, then both arms</source>
        <translation>Scheitel, dann beide Schenkel</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>Rückgängig</translation>
    </message>
    <message>
        <source>Undo the last change  (Ctrl+Z, redo Ctrl+Shift+Z)</source>
        <translation>Letzte Änderung rückgängig machen  (Strg+Z, wiederholen Strg+Umschalt+Z)</translation>
    </message>
    <message>
        <source>Delete</source>
        <translation>Löschen</translation>
    </message>
    <message>
        <source>Delete the selected measurement, otherwise the last  (Delete)</source>
        <translation>Ausgewählte Messung löschen, sonst die letzte  (Entf)</translation>
    </message>
    <message>
        <source>Clear</source>
        <translation>Leeren</translation>
    </message>
    <message>
        <source>Delete all measurements</source>
        <translation>Alle Messungen löschen</translation>
    </message>
    <message>
        <source>Needle</source>
        <translation>Nadel</translation>
    </message>
    <message>
        <source>Show the needle&apos;s path</source>
        <translation>Nadelweg zeigen</translation>
    </message>
    <message>
        <source>The needle axis near the image plane, and a cross at its intersection</source>
        <translation>Die Nadelachse nahe der Bildebene und ein Kreuz an ihrem Schnittpunkt</translation>
    </message>
    <message>
        <source>Needle guide line</source>
        <translation>Punktionslinie</translation>
    </message>
    <message>
        <source>A bracket that guides the needle into the image plane</source>
        <translation>Ein Punktionsaufsatz, der die Nadel in die Bildebene führt</translation>
    </message>
    <message>
        <source>Guide on the marked side</source>
        <translation>Aufsatz auf markierter Seite</translation>
    </message>
    <message>
        <source>The side of the green dot</source>
        <translation>Die Seite des grünen Punktes</translation>
    </message>
    <message>
        <source>Angle between the guide and the central axis of the beam</source>
        <translation>Winkel zwischen der Punktionslinie und der Mittelachse des Schallfelds</translation>
    </message>
    <message>
        <source>Colour Doppler</source>
        <translation>Farbdoppler</translation>
    </message>
    <message>
        <source>Show flow</source>
        <translation>Fluss zeigen</translation>
    </message>
    <message>
        <source>Colour Doppler  (C); drag the box</source>
        <translation>Farbdoppler  (C); das Farbfenster lässt sich ziehen</translation>
    </message>
    <message>
        <source>Scale</source>
        <translation>Skala</translation>
    </message>
    <message>
        <source>Velocity limit before aliasing (PRF)</source>
        <translation>Höchste Geschwindigkeit ohne Aliasing (PRF)</translation>
    </message>
    <message>
        <source>Baseline</source>
        <translation>Nulllinie</translation>
    </message>
    <message>
        <source>Baseline shift</source>
        <translation>Nulllinie verschieben</translation>
    </message>
    <message>
        <source>Colour gain: higher shows weaker flow, then noise</source>
        <translation>Farbverstärkung: höher zeigt schwächeren Fluss, dann Rauschen</translation>
    </message>
    <message>
        <source>Invert colours</source>
        <translation>Farben umkehren</translation>
    </message>
    <message>
        <source>Blue towards the transducer</source>
        <translation>Blau zum Schallkopf hin</translation>
    </message>
    <message>
        <source>Frozen</source>
        <translation>Eingefroren</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::UltrasoundPanel</name>
    <message>
        <source>Landmark pairs</source>
        <translation>Landmarkenpaare</translation>
    </message>
    <message>
        <source>Registration</source>
        <translation>Registrierung</translation>
    </message>
    <message>
        <source>Comparison</source>
        <translation>Vergleich</translation>
    </message>
    <message>
        <source>A sweep or a stitched panorama</source>
        <translation>Ein Schwenk oder ein zusammengesetztes Panorama</translation>
    </message>
    <message>
        <source>Ultrasound volume</source>
        <translation>Ultraschallvolumen</translation>
    </message>
    <message>
        <source>Gray levels 0 to 255: NRRD, NIfTI or MHA  (Enter reads it)</source>
        <translation>Graustufen 0 bis 255: NRRD, NIfTI oder MHA  (Enter liest es)</translation>
    </message>
    <message>
        <source>File…</source>
        <translation>Datei…</translation>
    </message>
    <message>
        <source>Select the file</source>
        <translation>Datei auswählen</translation>
    </message>
    <message>
        <source>Beam direction</source>
        <translation>Schallrichtung</translation>
    </message>
    <message>
        <source>Direction of sound along the volume&apos;s axes; the header&apos;s beams are used by default</source>
        <translation>Schallrichtung entlang der Volumenachsen; Vorgabe sind die Schallstrahlen aus dem Dateikopf</translation>
    </message>
    <message>
        <source>Beams of the header, or along +y</source>
        <translation>Strahlen des Dateikopfs oder entlang +y</translation>
    </message>
    <message>
        <source>Beams along %1</source>
        <translation>Strahlen entlang %1</translation>
    </message>
    <message>
        <source>Read</source>
        <translation>Lesen</translation>
    </message>
    <message>
        <source>Read the volume; it replaces another one</source>
        <translation>Volumen lesen; es ersetzt ein vorhandenes</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Entfernen</translation>
    </message>
    <message>
        <source>Remove the ultrasound from the case</source>
        <translation>Ultraschall aus dem Fall entfernen</translation>
    </message>
    <message>
        <source>Start of the registration</source>
        <translation>Start der Registrierung</translation>
    </message>
    <message>
        <source>First pose of the optimisation</source>
        <translation>Anfangslage der Optimierung</translation>
    </message>
    <message>
        <source>Start: present pose</source>
        <translation>Start: aktuelle Lage</translation>
    </message>
    <message>
        <source>Start: the volumes share a frame</source>
        <translation>Start: gemeinsames Bezugssystem</translation>
    </message>
    <message>
        <source>Start: search on the skin</source>
        <translation>Start: Suche auf der Haut</translation>
    </message>
    <message>
        <source>Register</source>
        <translation>Registrieren</translation>
    </message>
    <message>
        <source>Optimise the pose by mutual information; a result of low confidence is refused</source>
        <translation>Lage anhand der wechselseitigen Information optimieren; ein Ergebnis mit niedriger Konfidenz wird abgelehnt</translation>
    </message>
    <message>
        <source>How the ultrasound is drawn in the slices of the CT</source>
        <translation>Wie der Ultraschall in den Schnitten des CT dargestellt wird</translation>
    </message>
    <message>
        <source>Blend</source>
        <translation>Überblenden</translation>
    </message>
    <message>
        <source>Checkerboard</source>
        <translation>Schachbrett</translation>
    </message>
    <message>
        <source>Off</source>
        <translation>Aus</translation>
    </message>
    <message>
        <source>Share of the ultrasound</source>
        <translation>Anteil des Ultraschalls</translation>
    </message>
    <message>
        <source>Left: CT only. Right: ultrasound only. Checkerboard: size of the fields</source>
        <translation>Links: nur CT. Rechts: nur Ultraschall. Schachbrett: Größe der Felder</translation>
    </message>
    <message>
        <source>Trainees see this ultrasound</source>
        <translation>Lernende sehen diesen Ultraschall</translation>
    </message>
    <message>
        <source>Attempts begin with the recorded ultrasound; outside it, the simulated one is shown</source>
        <translation>Versuche beginnen mit dem aufgezeichneten Ultraschall; außerhalb davon wird der simulierte gezeigt</translation>
    </message>
    <message>
        <source>Import a patient first (step 1).</source>
        <translation>Importieren Sie zuerst einen Patienten (Schritt 1).</translation>
    </message>
    <message>
        <source>None: trainees get ultrasound that is simulated from the CT.</source>
        <translation>Keiner: Lernende erhalten einen aus dem CT simulierten Ultraschall.</translation>
    </message>
    <message>
        <source>%1: %2 × %3 × %4 mm</source>
        <translation>%1: %2 × %3 × %4 mm</translation>
    </message>
    <message>
        <source>No pose yet.</source>
        <translation>Noch keine Lage.</translation>
    </message>
    <message>
        <source>Pose: as saved with the case.</source>
        <translation>Lage: wie mit dem Fall gespeichert.</translation>
    </message>
    <message>
        <source>Pose: fit of the landmarks.</source>
        <translation>Lage: an die Landmarken angepasst.</translation>
    </message>
    <message>
        <source>Pose: optimised, confidence %1.</source>
        <translation>Lage: optimiert, Konfidenz %1.</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::UltrasoundView</name>
    <message>
        <source>Ultrasound picture</source>
        <translation>Ultraschallbild</translation>
    </message>
    <message>
        <source>No blood flow in this patient&apos;s vessels</source>
        <translation>Kein Blutfluss in den Gefäßen dieses Patienten</translation>
    </message>
    <message>
        <source>Computing the blood flow</source>
        <translation>Blutfluss wird berechnet</translation>
    </message>
    <message>
        <source>Poor contact</source>
        <translation>Schlechter Kontakt</translation>
    </message>
    <message>
        <source>Outside CT</source>
        <translation>Außerhalb des CT</translation>
    </message>
    <message>
        <source>Waiting for the first image</source>
        <translation>Warten auf das erste Bild</translation>
    </message>
    <message>
        <source>No patient</source>
        <translation>Kein Patient</translation>
    </message>
    <message>
        <source>Preparing the ultrasound</source>
        <translation>Ultraschall wird vorbereitet</translation>
    </message>
    <message>
        <source>Controls</source>
        <translation>Bedienung</translation>
    </message>
    <message>
        <source>Ultrasound</source>
        <translation>Ultraschall</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::Workspace</name>
    <message>
        <source>Undock the view, or dock it again</source>
        <translation>Ansicht ablösen oder wieder andocken</translation>
    </message>
    <message>
        <source>Hide the view; show it again with the menu Views</source>
        <translation>Ansicht ausblenden; das Menü „Ansichten“ blendet sie wieder ein</translation>
    </message>
    <message>
        <source>Layout: %1</source>
        <translation>Anordnung: %1</translation>
    </message>
    <message>
        <source>Reset layout</source>
        <translation>Anordnung zurücksetzen</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::XrayControls</name>
    <message>
        <source>Fluoroscopy (hold)</source>
        <translation>Durchleuchtung (halten)</translation>
    </message>
    <message>
        <source>X-rays while it is held, with the key Z held, too</source>
        <translation>Röntgenstrahlung, solange gedrückt; auch mit gedrückter Taste Z</translation>
    </message>
    <message>
        <source>Inject contrast (hold)</source>
        <translation>Kontrastmittel (halten)</translation>
    </message>
    <message>
        <source>Contrast agent through the needle while it is held, with the key J held, too</source>
        <translation>Kontrastmittel durch die Nadel, solange gedrückt; auch mit gedrückter Taste J</translation>
    </message>
    <message>
        <source>C-arm</source>
        <translation>C-Bogen</translation>
    </message>
    <message>
        <source>Turns the C-arm to this projection</source>
        <translation>Dreht den C-Bogen in diese Projektion</translation>
    </message>
    <message>
        <source>RAO–LAO</source>
        <translation>RAO–LAO</translation>
    </message>
    <message>
        <source>Detector to the patient&apos;s right or left</source>
        <translation>Detektor zur rechten oder linken Seite des Patienten</translation>
    </message>
    <message>
        <source>CAUD–CRAN</source>
        <translation>CAUD–CRAN</translation>
    </message>
    <message>
        <source>Detector towards feet or head</source>
        <translation>Detektor zu den Füßen oder zum Kopf</translation>
    </message>
    <message>
        <source>Table</source>
        <translation>Tisch</translation>
    </message>
    <message>
        <source>Height of the table: nearer to the detector is smaller</source>
        <translation>Höhe des Tisches: Näher am Detektor ist das Bild kleiner</translation>
    </message>
    <message>
        <source>Field</source>
        <translation>Feld</translation>
    </message>
    <message>
        <source>Edge of the field: a smaller one magnifies</source>
        <translation>Kantenlänge des Feldes: Ein kleineres vergrößert</translation>
    </message>
    <message>
        <source>%1 cm</source>
        <translation>%1 cm</translation>
    </message>
    <message>
        <source>Width</source>
        <translation>Breite</translation>
    </message>
    <message>
        <source>Collimator: irradiated share of the field</source>
        <translation>Blende: bestrahlter Anteil des Feldes</translation>
    </message>
    <message>
        <source>Height</source>
        <translation>Höhe</translation>
    </message>
    <message>
        <source>Exposure</source>
        <translation>Aufnahme</translation>
    </message>
    <message>
        <source>Pulses</source>
        <translation>Pulse</translation>
    </message>
    <message>
        <source>Pulses a second: fewer give less dose</source>
        <translation>Pulse pro Sekunde: Weniger ergeben weniger Dosis</translation>
    </message>
    <message>
        <source>%1 per s</source>
        <translation>%1 pro s</translation>
    </message>
    <message>
        <source>Dose</source>
        <translation>Dosis</translation>
    </message>
    <message>
        <source>Dose at the detector: half, normal or double</source>
        <translation>Dosis am Detektor: halb, normal oder doppelt</translation>
    </message>
    <message>
        <source>low</source>
        <translation>niedrig</translation>
    </message>
    <message>
        <source>normal</source>
        <translation>normal</translation>
    </message>
    <message>
        <source>high</source>
        <translation>hoch</translation>
    </message>
    <message>
        <source>Image</source>
        <translation>Bild</translation>
    </message>
    <message>
        <source>Mode</source>
        <translation>Modus</translation>
    </message>
    <message>
        <source>Subtraction: the first images are the mask, later ones show what was added. Road map: live, with the filled ducts or vessels of the last subtraction</source>
        <translation>Subtraktion: Die ersten Bilder sind die Maske, spätere zeigen, was hinzugekommen ist. Roadmap: live, mit den gefüllten Gängen oder Gefäßen der letzten Subtraktion</translation>
    </message>
    <message>
        <source>live</source>
        <translation>live</translation>
    </message>
    <message>
        <source>subtraction</source>
        <translation>Subtraktion</translation>
    </message>
    <message>
        <source>road map</source>
        <translation>Roadmap</translation>
    </message>
    <message>
        <source>Bones white</source>
        <translation>Knochen weiß</translation>
    </message>
</context>
<context>
    <name>trocar::trainer::XrayView</name>
    <message>
        <source>X-ray picture</source>
        <translation>Röntgenbild</translation>
    </message>
    <message>
        <source>Left button: moves the table; right button: turns the C-arm; wheel: field</source>
        <translation>Linke Maustaste: verschiebt den Tisch; rechte Maustaste: dreht den C-Bogen; Mausrad: Feld</translation>
    </message>
    <message>
        <source>No patient</source>
        <translation>Kein Patient</translation>
    </message>
    <message>
        <source>Preparing the X-ray</source>
        <translation>Röntgen wird vorbereitet</translation>
    </message>
    <message>
        <source>Hold Z or the pedal for fluoroscopy</source>
        <translation>Für die Durchleuchtung Z oder das Pedal gedrückt halten</translation>
    </message>
    <message>
        <source>LAO</source>
        <translation>LAO</translation>
    </message>
    <message>
        <source>RAO</source>
        <translation>RAO</translation>
    </message>
    <message>
        <source>CRAN</source>
        <translation>CRAN</translation>
    </message>
    <message>
        <source>CAUD</source>
        <translation>CAUD</translation>
    </message>
    <message>
        <source>Field %1 cm</source>
        <translation>Feld %1 cm</translation>
    </message>
    <message>
        <source>%1 kV
%2 mAs
%3 pulses/s</source>
        <translation>%1 kV
%2 mAs
%3 Pulse/s</translation>
    </message>
    <message>
        <source>%1 s
%2 mGy
%3 Gy cm²</source>
        <translation>%1 s
%2 mGy
%3 Gy cm²</translation>
    </message>
    <message>
        <source>Contrast %1 ml
</source>
        <translation>Kontrastmittel %1 ml
</translation>
    </message>
    <message>
        <source>Last image</source>
        <translation>Letztes Bild</translation>
    </message>
    <message>
        <source>● X-rays on</source>
        <translation>● Strahlung an</translation>
    </message>
    <message>
        <source>A</source>
        <comment>anterior side of an X-ray image</comment>
        <translation>A</translation>
    </message>
    <message>
        <source>R</source>
        <comment>right side of the patient</comment>
        <translation>R</translation>
    </message>
    <message>
        <source>P</source>
        <comment>posterior side of an X-ray image</comment>
        <translation>P</translation>
    </message>
    <message>
        <source>L</source>
        <comment>left side of the patient</comment>
        <translation>L</translation>
    </message>
    <message>
        <source>Controls</source>
        <translation>Bedienung</translation>
    </message>
    <message>
        <source>Pedal, C-arm and image controls next to the X-ray image</source>
        <translation>Pedal, C-Bogen und Bildregler neben dem Röntgenbild</translation>
    </message>
    <message>
        <source>X-ray</source>
        <translation>Röntgen</translation>
    </message>
    <message>
        <source>The X-ray images of the attempt, with the recorded C-arm, dose and contrast agent</source>
        <translation>Die Röntgenbilder des Versuchs mit den aufgezeichneten Werten von C-Bogen, Dosis und Kontrastmittel</translation>
    </message>
    <message>
        <source>No X-rays yet</source>
        <translation>Noch kein Röntgenbild</translation>
    </message>
    <message>
        <source>Computing the image</source>
        <translation>Bild wird berechnet</translation>
    </message>
</context>
</TS>
