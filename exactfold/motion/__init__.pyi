from exactfold.motion.angles import fold_angles_of as fold_angles_of
from exactfold.motion.configuration_graph import (
    ConfigurationGraph as ConfigurationGraph,
)
from exactfold.motion.contact_claims import (
    certificate_with_contact as certificate_with_contact,
)
from exactfold.motion.contacts import FirstContact as FirstContact
from exactfold.motion.contacts import first_contact as first_contact
from exactfold.motion.drive import Drive as Drive
from exactfold.motion.driven import Driven as Driven
from exactfold.motion.driven import find_driven as find_driven
from exactfold.motion.events import Event as Event
from exactfold.motion.followable import PanelComponent as PanelComponent
from exactfold.motion.followable import PanelMode as PanelMode
from exactfold.motion.followable import panel_components as panel_components
from exactfold.motion.followable import panel_modes as panel_modes
from exactfold.motion.following import follow as follow
from exactfold.motion.framework import Framework as Framework
from exactfold.motion.half_branches import HalfBranch as HalfBranch
from exactfold.motion.links import Link as Link
from exactfold.motion.loop_proofs import Loop as Loop
from exactfold.motion.loop_proofs import LoopProof as LoopProof
from exactfold.motion.matching import Loops as Loops
from exactfold.motion.matching import find_loops as find_loops
from exactfold.motion.motion import Motion as Motion
from exactfold.motion.panel_clearance import PanelClearance as PanelClearance
from exactfold.motion.panel_clearance import prove_contacts as prove_contacts
from exactfold.motion.panel_following import follow_panels as follow_panels
from exactfold.motion.panel_motion import PanelMotion as PanelMotion
from exactfold.motion.panel_proving import PanelProof as PanelProof
from exactfold.motion.panel_proving import prove_panels as prove_panels
from exactfold.motion.piece import Ball as Ball
from exactfold.motion.proving import MotionProof as MotionProof
from exactfold.motion.proving import prove as prove
from exactfold.motion.start import Start as Start
from exactfold.motion.tracks import Frame as Frame
from exactfold.motion.tracks import Track as Track
from exactfold.motion.tracks import follow_proved as follow_proved
from exactfold.motion.tracks import half_branch as half_branch
from exactfold.motion.tube import Tube as Tube
from exactfold.motion.tube_start import StartTube as StartTube
from exactfold.motion.writing import write_motion as write_motion
